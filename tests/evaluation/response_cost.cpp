#include "tests/evaluation/response_cost.h"

#include <tbb/global_control.h>

#include "server/render/display_framelet.h"
#include "server/render/probe_renderer.h"
#include "server/sampling/plan/adaptive_refresh.h"
#include "server/stream/layers/layer_fit.h"
#include "server/stream/moment_choice.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {

ResponseCost response_cost(BenchScene& scene, Viewport viewport, double samples_per_second, double seconds) {
    tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
    AdaptiveRefresh refresh;
    ProbeRenderer probes;
    std::vector<DisplayFramelet> displayed;
    std::vector<Framelet> rendered;
    std::vector<FrameletShape> shapes;
    std::vector<std::uint8_t> sent;
    BodyMotions const motions;
    RefreshInput input;
    RefreshPlan plan;
    input.samples_per_second = samples_per_second;
    input.motions = &motions;
    double plan_seconds = 0;
    std::uint64_t batch = 0;
    ResponseCost cost;
    // The first tenth of the time is not counted: a picture that first appears costs differently.
    for (double const start = 0.1 * seconds; input.now < seconds;) {
        input.state = {{1, scene.camera, viewport}, scene.exposure, input.now};
        input.cycle_seconds = cycle_length(false, plan_seconds);
        if (!input.moment || input.now > input.moment->begun + least_moment_seconds) {
            input.moment = HeldMoment{input.state, input.now};
        }
        pose_at(scene, input.moment->state.scene_time);
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
        shapes.resize(rendered.size());
        for (std::size_t i = 0; i < rendered.size(); ++i) { // has a cost of its own in the table
            fit_layers(rendered[i], ImagePlane(viewport), {1e-3f}, shapes[i]);
        }
        double const learnt = processor_seconds_of([&] {
            sent = refresh.learn(plan, displayed, rendered, probes.looks());
            refresh.note_sent(plan, ++batch, displayed, rendered, sent, shapes);
        });
        if (input.now >= start) {
            cost.plan += planned;
            cost.learn += learnt;
            cost.cycles += plan.is_new_cycle ? 1 : 0;
            cost.samples += rendered.size() * framelet_samples;
        }
        double const samples = static_cast<double>(rendered.size() * framelet_samples + plan.probes.size());
        input.now += std::max(samples, 1.0) / samples_per_second;
    }
    cost.regions = refresh.regions().visible().size();
    pose_at(scene, 0);
    return cost;
}

} // namespace framelet::bench
