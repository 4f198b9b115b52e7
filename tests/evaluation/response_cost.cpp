#include "tests/evaluation/response_cost.h"

#include <cstdio>

#include <nlohmann/json.hpp>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include "common/color.h"
#include "common/cpu_clock.h"
#include "protocol/batch_codec.h"
#include "server/render/probe_renderer.h"
#include "server/schedule/adaptive_refresh.h"
#include "tests/evaluation/charts/charts.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

double cpu_seconds(auto&& work) {
    double const start = cpu_seconds_of(CLOCK_THREAD_CPUTIME_ID);
    work();
    return cpu_seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
}

/// Samples a second that one thread renders and encodes.
double one_thread_rate(BenchScene& scene) {
    ResponseCost const cost = response_cost(scene, {256, 256}, 1e6, 0.2);
    return static_cast<double>(cost.samples) / (cost.render + cost.encode);
}

void draw_chart(json const& sizes, std::string const& scene, std::filesystem::path const& folder) {
    Curves chart{.title = scene + ": what the response costs",
                 .x_title = "side of the picture [pixels]",
                 .y_title = "of the server's CPU [%]",
                 .log_x = true,
                 .curves = {{"response, all of it", {}, {}}, {"planning", {}, {}}}};
    for (json const& size : sizes) {
        chart.curves[0].x.push_back(size["side"]);
        chart.curves[0].y.push_back(100 * size["share"].get<double>());
        chart.curves[1].x.push_back(size["side"]);
        chart.curves[1].y.push_back(100 * size["plan_share"].get<double>());
    }
    std::filesystem::create_directories(folder);
    draw(chart, folder / (scene + "-response"));
}

} // namespace

ResponseCost response_cost(BenchScene& scene, Viewport viewport, double samples_per_second, double seconds) {
    tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
    AdaptiveRefresh refresh;
    ProbeRenderer probes;
    BatchCodec codec;
    Batch batch;
    std::vector<Framelet> rendered;
    RefreshInput input;
    RefreshPlan plan;
    input.samples_per_second = samples_per_second;
    double plan_seconds = 0;
    ResponseCost cost;
    // The first tenth is a picture that appears, which is another matter.
    for (double const start = 0.1 * seconds; input.now < seconds;) {
        pose_at(scene, input.now);
        input.state = {{1, scene.camera, viewport}, scene.exposure, input.now};
        input.cycle_seconds = cycle_length(false, plan_seconds);
        double const planned = cpu_seconds([&] { refresh.plan(input, plan); });
        if (plan.is_new_cycle) {
            plan_seconds = planned;
        }
        rendered.resize(plan.tiles.size());
        batch.framelets.resize(rendered.size());
        double const traced = cpu_seconds([&] {
            render_framelets(*scene.render_scene, scene.camera, ImagePlane(viewport), plan.tiles, 0, rendered);
            probes.render(*scene.render_scene, scene.camera, viewport, scene.exposure, plan.probes);
        });
        double encoded = cpu_seconds([&] {
            for (std::size_t i = 0; i < rendered.size(); ++i) {
                batch.framelets[i] = to_display(rendered[i], scene.exposure);
            }
        });
        std::vector<std::uint8_t> const* send = nullptr;
        double const learnt =
            cpu_seconds([&] { send = &refresh.learn(plan, batch.framelets, rendered, probes.luma()); });
        encoded += cpu_seconds([&] {
            std::size_t kept = 0;
            for (std::size_t i = 0; i < rendered.size(); ++i) {
                if ((*send)[i] != 0) {
                    batch.framelets[kept++] = batch.framelets[i];
                }
            }
            batch.framelets.resize(kept);
            codec.encode(batch);
        });
        if (input.now >= start) {
            cost.plan += planned;
            cost.learn += learnt;
            cost.render += traced;
            cost.encode += encoded;
            cost.cycles += plan.is_new_cycle ? 1 : 0;
            ++cost.batches;
            cost.samples += rendered.size() * framelet_samples;
        }
        double const samples = static_cast<double>(rendered.size() * framelet_samples + plan.probes.size());
        input.now += std::max(samples, 1.0) / samples_per_second;
    }
    cost.places = refresh.field().visible().size();
    pose_at(scene, 0);
    return cost;
}

json measure_response(BenchScene& scene, ResponseStudy const& study) {
    int const threads = tbb::info::default_concurrency();
    double const rate = threads * one_thread_rate(scene);
    std::printf("%s, %d threads, %.2f Msamples/s, %g s of movement\n\n", scene.name.c_str(), threads, 1e-6 * rate,
                study.seconds);
    std::printf("  side   places  cycles  batches  Msamples   plan us a cycle   learn ns a sample   share of CPU\n");
    json sizes = json::array();
    for (int const side : study.sides) {
        ResponseCost const cost = response_cost(scene, {side, side}, rate, study.seconds);
        double const plan_us = 1e6 * cost.plan / static_cast<double>(cost.cycles);
        double const learn_ns = 1e9 * cost.learn / static_cast<double>(cost.samples);
        std::printf("  %4d  %7zu  %6zu  %7zu  %8.2f  %16.1f  %18.2f  %12.2f%%\n", side, cost.places, cost.cycles,
                    cost.batches, 1e-6 * static_cast<double>(cost.samples), plan_us, learn_ns, 100 * cost.share());
        sizes.push_back({{"side", side},
                         {"places", cost.places},
                         {"cycles", cost.cycles},
                         {"batches", cost.batches},
                         {"samples", cost.samples},
                         {"plan_us_per_cycle", plan_us},
                         {"learn_ns_per_sample", learn_ns},
                         {"plan_share", cost.plan / (cost.response() + cost.render + cost.encode)},
                         {"share", cost.share()}});
    }
    if (!study.charts.empty()) {
        draw_chart(sizes, scene.name, study.charts);
    }
    return {{"scene", scene.name}, {"threads", threads}, {"samples_per_second", rate}, {"sizes", sizes}};
}

} // namespace framelet::bench
