#include "tests/evaluation/response_cost.h"

#include <tbb/global_control.h>

#include "server/render/display_framelet.h"
#include "server/render/probe_renderer.h"
#include "server/sampling/plan/adaptive_refresh.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {

ResponseCost response_cost(BenchScene& scene, Viewport viewport, double samples_per_second, double seconds) {
    tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
    AdaptiveRefresh refresh;
    ProbeRenderer probes;
    std::vector<DisplayFramelet> displayed;
    std::vector<Framelet> rendered;
    RefreshInput input;
    RefreshPlan plan;
    input.samples_per_second = samples_per_second;
    double plan_seconds = 0;
    ResponseCost cost;
    // The first tenth of the time is not counted: a picture that first appears costs differently.
    for (double const start = 0.1 * seconds; input.now < seconds;) {
        pose_at(scene, input.now);
        input.state = {{1, scene.camera, viewport}, scene.exposure, input.now};
        input.cycle_seconds = cycle_length(false, plan_seconds);
        double const planned = processor_seconds_of([&] { refresh.plan(input, plan); });
        if (plan.is_new_cycle) {
            plan_seconds = planned;
        }
        rendered.resize(plan.tiles.size());
        displayed.resize(rendered.size());
        render_framelets(*scene.render_scene, scene.camera, ImagePlane(viewport), plan.tiles, rendered);
        probes.render(*scene.render_scene, scene.camera, viewport, scene.exposure, plan.probes);
        for (std::size_t i = 0; i < rendered.size(); ++i) {
            displayed[i] = to_display(rendered[i], scene.exposure);
        }
        double const learnt = processor_seconds_of([&] { refresh.learn(plan, displayed, rendered, probes.luma()); });
        if (input.now >= start) {
            cost.plan += planned;
            cost.learn += learnt;
            cost.cycles += plan.is_new_cycle ? 1 : 0;
            cost.samples += rendered.size() * framelet_samples;
        }
        double const samples = static_cast<double>(rendered.size() * framelet_samples + plan.probes.size());
        input.now += std::max(samples, 1.0) / samples_per_second;
    }
    cost.regions = refresh.field().visible().size();
    pose_at(scene, 0);
    return cost;
}

} // namespace framelet::bench
