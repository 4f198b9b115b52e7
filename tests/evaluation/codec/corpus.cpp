#include "tests/evaluation/codec/corpus.h"

#include "common/color.h"
#include "server/layers/shape_feed.h"
#include "server/render/probe_renderer.h"
#include "server/schedule/adaptive_refresh.h"

namespace framelet::bench {
namespace {

constexpr float cycle_seconds = 0.02f;

CorpusMoment make_moment(BenchScene& scene, CorpusOptions const& options, double begin) {
    ImagePlane const plane(options.viewport);
    double const pixels = static_cast<double>(options.viewport.width) * options.viewport.height;
    AdaptiveRefresh refresh;
    ProbeRenderer probes;
    std::vector<Framelet> rendered;
    std::vector<DisplayFramelet> display;
    RefreshInput input;
    RefreshPlan plan;
    ShapeFeed feed;
    input.samples_per_second = options.frames_per_second * pixels;
    input.cycle_seconds = cycle_seconds;
    CorpusMoment moment;
    std::uint64_t number = 0;
    while (input.now < options.lead_seconds + options.seconds) {
        SceneTime const time = begin + input.now;
        pose_at(scene, time);
        NumberedView const view{number + 1, scene.camera, options.viewport};
        input.state = {view, scene.exposure, time};
        refresh.plan(input, plan);
        rendered.resize(plan.tiles.size());
        render_framelets(*scene.render_scene, scene.camera, plane, plan.tiles, 0, rendered);
        probes.render(*scene.render_scene, scene.camera, options.viewport, scene.exposure, plan.probes);
        display.clear();
        for (Framelet const& framelet : rendered) {
            display.push_back(to_display(framelet, scene.exposure));
        }
        auto const& send = refresh.learn(plan, display, rendered, probes.luma());
        Batch batch{++number, view, time, {}};
        for (std::size_t i = 0; i < display.size(); ++i) {
            if (send[i] != 0) {
                batch.framelets.push_back(display[i]);
            }
        }
        feed.fit(rendered, send, make_view_rays(scene.camera, options.viewport), plane, input.now, batch.shapes);
        if (!batch.framelets.empty()) {
            (input.now < options.lead_seconds ? moment.lead : moment.batches).push_back(std::move(batch));
        }
        double const samples = static_cast<double>(plan.tiles.size() * framelet_samples + plan.probes.size());
        input.now += std::max(samples / input.samples_per_second, 1e-3);
    }
    return moment;
}

} // namespace

std::vector<CorpusMoment> make_corpus(BenchScene& scene, CorpusOptions const& options) {
    std::vector<CorpusMoment> corpus;
    double const last = std::max(scene.duration - options.lead_seconds - options.seconds, 0.0);
    for (int i = 0; i < options.moments; ++i) {
        corpus.push_back(make_moment(scene, options, last * (i + 0.5) / options.moments));
    }
    pose_at(scene, 0);
    return corpus;
}

} // namespace framelet::bench
