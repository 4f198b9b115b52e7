#include "tests/evaluation/limits.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <functional>
#include <thread>

#include <nlohmann/json.hpp>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include "common/color.h"
#include "common/framelet_cache.h"
#include "common/reconstruction.h"
#include "protocol/batch_codec.h"
#include "server/schedule/tiling.h"
#include "server/session/server.h"
#include "tests/evaluation/sink_viewer.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// Embree and shading alone: the same tiles as the server's batches, one parallel loop over all of them.
double bare_loop_seconds(BenchScene& scene, Viewport viewport, std::vector<Tile> const& tiles) {
    ImagePlane const plane(viewport);
    ViewRays const rays = make_view_rays(scene.camera, viewport);
    return seconds_of([&] {
        tbb::parallel_for(std::size_t(0), tiles.size(), [&](std::size_t i) {
            thread_local Framelet framelet;
            render_framelet(*scene.render_scene, rays, plane, tiles[i], 0, framelet);
        });
    });
}

/// The whole server, its socket included, against the bare loop on the very same framelets.
json measure_server(BenchScene& scene, LimitsOptions const& options) {
    ServerOptions server_options;
    server_options.port = 0;
    server_options.paused = true;
    server_options.loop.stream.exposure = scene.exposure;
    Server server(scene.scene, scene.clips, *scene.render_scene, server_options);
    std::jthread const running([&server] { server.run(false); });

    std::vector<double> ratios, server_rates, bare_rates;
    SinkRecord record;
    for (int round = 0; round < options.rounds; ++round) {
        record = watch_until_repeated(server.port(), scene.camera, options.viewport);
        std::vector<Tile> tiles;
        for (auto const& batch : record.batches) {
            tiles.insert(tiles.end(), batch.begin(), batch.end());
        }
        double const samples = static_cast<double>(record.samples);
        server_rates.push_back(samples / record.seconds);
        bare_rates.push_back(samples / bare_loop_seconds(scene, options.viewport, tiles));
        ratios.push_back(server_rates.back() / bare_rates.back());
    }
    server.stop();
    return {{"samples", record.samples},
            {"batches", record.batches.size()},
            {"bytes_per_sample", static_cast<double>(record.payload_bytes) / static_cast<double>(record.samples)},
            {"server_samples_per_second", median(server_rates)},
            {"bare_samples_per_second", median(bare_rates)},
            {"ratio", median(ratios)}};
}

/// Rounds of one stage on one thread, each beside a memcpy of the bytes that it has to move. What a median says depends
/// on what shares the machine; the fastest round says most of what the stage itself costs.
json measure_stage(int rounds, double units, std::size_t bytes, std::function<void()> const& stage) {
    std::vector<std::byte> const from(bytes);
    std::vector<std::byte> to(bytes);
    std::vector<double> stage_ns, copy_ns, ratios;
    for (int round = 0; round < rounds; ++round) {
        double const copy = processor_seconds_of([&] { std::memcpy(to.data(), from.data(), bytes); });
        double const work = processor_seconds_of(stage);
        stage_ns.push_back(1e9 * work / units);
        copy_ns.push_back(1e9 * copy / units);
        ratios.push_back(work / copy);
    }
    return {{"ns", median(stage_ns)},
            {"fastest_ns", *std::ranges::min_element(stage_ns)},
            {"memcpy_ns", median(copy_ns)},
            {"times_memcpy", median(ratios)}};
}

json measure_stages(BenchScene& scene, LimitsOptions const& options) {
    ImagePlane const plane(options.viewport);
    Tiling const tiling = make_uniform_tiling(plane, plane.pixel_depth());
    std::vector<Framelet> rendered(tiling.tiles.size());
    render_framelets(*scene.render_scene, scene.camera, plane, tiling.tiles, 0, rendered);

    tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
    Batch batch;
    batch.number = 1;
    batch.view = {1, scene.camera, options.viewport};
    batch.framelets.resize(rendered.size());
    double const samples = static_cast<double>(rendered.size() * framelet_samples);
    std::size_t const bytes = rendered.size() * framelet_samples * 3;
    json result;
    result["display"] = measure_stage(options.rounds, samples, bytes, [&] {
        std::transform(rendered.begin(), rendered.end(), batch.framelets.begin(),
                       [&](Framelet const& framelet) { return to_display(framelet, scene.exposure); });
    });
    BatchCodec codec;
    EncodedBatch encoded;
    Batch decoded;
    result["encode"] = measure_stage(options.rounds, samples, bytes, [&] { encoded = codec.encode(batch); });
    result["decode"] = measure_stage(options.rounds, samples, bytes, [&] { decoded = codec.decode(encoded); });
    result["encode"]["bytes_per_sample"] = static_cast<double>(encoded.payload.size()) / samples;

    FrameletCache cache(plane);
    Picture picture(options.viewport.width, options.viewport.height);
    std::vector<PixelRect> changed;
    double const pixels = static_cast<double>(picture.rgba.size() / 4);
    result["cache"] = measure_stage(options.rounds, samples, bytes, [&] {
        ++decoded.number;
        cache.insert(decoded);
    });
    result["reconstruct"] = measure_stage(options.rounds, pixels, picture.rgba.size(), [&] {
        ++decoded.number;
        cache.insert(decoded);
        cache.take_changed(changed);
        reconstruct(cache, changed, picture);
    });
    return result;
}

} // namespace

json measure_limits(BenchScene& scene, LimitsOptions const& options) {
    json result;
    result["scene"] = scene.name;
    result["viewport"] = {options.viewport.width, options.viewport.height};
    result["threads"] = tbb::info::default_concurrency();
    result["server"] = measure_server(scene, options);
    result["stages"] = measure_stages(scene, options);

    json const& server = result["server"];
    std::printf("%s, %dx%d, %d threads, medians of %d rounds and the fastest one\n\n", scene.name.c_str(),
                options.viewport.width, options.viewport.height, result["threads"].get<int>(), options.rounds);
    std::printf("rendering, all threads        Msamples/s\n");
    std::printf("  bare Embree + shading loop  %8.2f\n", server["bare_samples_per_second"].get<double>() / 1e6);
    std::printf("  whole server                %8.2f   %.3f of the bare loop, %.2f B/sample on the wire\n\n",
                server["server_samples_per_second"].get<double>() / 1e6, server["ratio"].get<double>(),
                server["bytes_per_sample"].get<double>());
    std::printf("one thread, ns a sample         median  fastest   memcpy   times memcpy (medians)\n");
    auto const print = [](char const* name, json const& figures, char const* remark) {
        std::printf("  %-28s %8.2f %8.2f %8.2f %10.1f%s\n", name, figures["ns"].get<double>(),
                    figures["fastest_ns"].get<double>(), figures["memcpy_ns"].get<double>(),
                    figures["times_memcpy"].get<double>(), remark);
    };
    json const& stages = result["stages"];
    for (auto const* stage : {"display", "encode", "decode", "cache"}) {
        print(stage, stages[stage], "");
    }
    print("reconstruct", stages["reconstruct"], "   (a pixel, insertion included)");
    return result;
}

} // namespace framelet::bench
