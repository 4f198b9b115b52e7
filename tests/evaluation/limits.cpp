#include "tests/evaluation/limits.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <thread>

#include <nlohmann/json.hpp>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include "common/color.h"
#include "common/cpu_clock.h"
#include "common/framelet_cache.h"
#include "common/picture/framelet_pool.h"
#include "common/reconstruction.h"
#include "common/reprojector.h"
#include "protocol/batch_codec.h"
#include "server/layers/layer_fit.h"
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

/// Processor time of this thread: what else the machine does makes less of a difference to it.
double cpu_seconds_to(std::function<void()> const& work) {
    double const start = cpu_seconds_of(CLOCK_THREAD_CPUTIME_ID);
    work();
    return cpu_seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
}

/// Rounds of one stage on one thread, each beside a memcpy of the bytes that it has to move. What a median says depends
/// on what shares the machine; the fastest round says most of what the stage itself costs.
class Rounds {
public:
    Rounds(double units, std::size_t bytes) : units_(units), from_(bytes), to_(bytes) {}

    /// `stage` returns the processor time that it took.
    void add(std::function<double()> const& stage) {
        double const copy = cpu_seconds_to([&] { std::memcpy(to_.data(), from_.data(), from_.size()); });
        double const work = stage();
        stage_ns_.push_back(1e9 * work / units_);
        copy_ns_.push_back(1e9 * copy / units_);
        ratios_.push_back(work / copy);
    }

    json figures() const {
        return {{"ns", median(stage_ns_)},
                {"fastest_ns", *std::ranges::min_element(stage_ns_)},
                {"memcpy_ns", median(copy_ns_)},
                {"times_memcpy", median(ratios_)}};
    }

private:
    double units_;
    std::vector<std::byte> from_, to_;
    std::vector<double> stage_ns_, copy_ns_, ratios_;
};

json measure_stage(int rounds, double units, std::size_t bytes, std::function<void()> const& stage) {
    Rounds all(units, bytes);
    for (int round = 0; round < rounds; ++round) {
        all.add([&] { return cpu_seconds_to(stage); });
    }
    return all.figures();
}

/// Everything held was taken with the scene's camera by `levels` levels more than a sample a pixel; the camera moves a
/// little on for each picture, so that every pixel changes.
class MovedPictures {
public:
    static constexpr int pictures = 4; ///< a round, and one before that brings its memory near again

    MovedPictures(BenchScene& scene, Viewport viewport, int levels)
        : camera_(scene.camera), pool_(ImagePlane(viewport)), picture_(viewport.width, viewport.height) {
        ImagePlane const plane(viewport);
        Tiling const tiling = make_uniform_tiling(plane, plane.pixel_depth() + levels);
        std::vector<Framelet> rendered(tiling.tiles.size());
        render_framelets(*scene.render_scene, scene.camera, plane, tiling.tiles, 0, rendered);
        depth_ = median_depth(rendered);
        LayerTolerance const tolerance = layer_tolerance(depth_, make_view_rays(scene.camera, viewport));
        for (std::size_t part = 0; part < parts; ++part) {
            Batch& batch = batches_[part];
            batch.number = part + 1;
            batch.view = {1, scene.camera, viewport};
            for (std::size_t i = part; i < rendered.size(); i += parts) {
                batch.framelets.push_back(to_display(rendered[i], scene.exposure));
                fit_layers(rendered[i], plane, tolerance, batch.shapes.emplace_back());
            }
            pool_.insert(batch);
        }
    }

    /// Processor time of a round on one thread. `arriving`: every fifth framelet is replaced before each picture, which
    /// is not counted.
    double show(bool arriving) {
        tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
        double seconds = 0;
        for (int i = -1; i < pictures; ++i) {
            Batch& batch = batches_[shown_ % parts];
            if (arriving) {
                batch.number += parts;
                pool_.insert(batch);
            }
            pool_.newest().take_changed(arrived_);
            auto const way = static_cast<float>(++shown_);
            Camera camera = camera_;
            camera.position += 1e-3f * way * depth_ * camera_.right();
            camera.orientation = glm::normalize(glm::angleAxis(2e-3f * way, Vec3(0, 1, 0)) * camera.orientation);
            double const took =
                cpu_seconds_to([&] { reprojector_.show(pool_, arrived_, camera, 0, {}, picture_, changed_); });
            seconds += i < 0 ? 0 : took;
        }
        return seconds;
    }

private:
    static constexpr std::size_t parts = 5;

    Camera camera_;
    FrameletPool pool_;
    Reprojector reprojector_;
    Picture picture_;
    float depth_ = 0;
    std::array<Batch, parts> batches_;
    std::vector<PixelRect> arrived_, changed_;
    std::size_t shown_ = 0;
};

constexpr std::array reprojections{"reproject, spacing 2", "reproject, spacing 1", "reproject, spacing 1/2",
                                   "reproject, spacing 1/4"};

/// Rounds of all spacings in turn: what else the machine does meanwhile hits all of them alike.
void measure_reprojection(BenchScene& scene, LimitsOptions const& options, json& stages) {
    std::size_t const pixels =
        static_cast<std::size_t>(options.viewport.width) * static_cast<std::size_t>(options.viewport.height);
    Rounds const none(MovedPictures::pictures * static_cast<double>(pixels), MovedPictures::pictures * 4 * pixels);
    std::vector<Rounds> staying(reprojections.size(), none), arriving(reprojections.size(), none);
    std::vector<std::unique_ptr<MovedPictures>> pictures;
    for (std::size_t i = 0; i < reprojections.size(); ++i) {
        pictures.push_back(std::make_unique<MovedPictures>(scene, options.viewport, static_cast<int>(i) - 1));
    }
    for (int round = 0; round < options.rounds; ++round) {
        for (std::size_t i = 0; i < reprojections.size(); ++i) {
            staying[i].add([&] { return pictures[i]->show(false); });
            arriving[i].add([&] { return pictures[i]->show(true); });
        }
    }
    for (std::size_t i = 0; i < reprojections.size(); ++i) {
        stages[reprojections[i]] = staying[i].figures();
        stages[reprojections[i]]["arriving"] = arriving[i].figures();
    }
}

/// The viewer alone on all threads: a fifth of the picture arrives for each one shown, the camera moves all the time.
json measure_viewer(BenchScene& scene, LimitsOptions const& options) {
    constexpr std::size_t parts = 5;
    constexpr int pictures = 30; // a round
    ImagePlane const plane(options.viewport);
    Tiling const tiling = make_uniform_tiling(plane, plane.pixel_depth());
    std::vector<Framelet> rendered(tiling.tiles.size());
    render_framelets(*scene.render_scene, scene.camera, plane, tiling.tiles, 0, rendered);
    float const depth = median_depth(rendered);
    LayerTolerance const tolerance = layer_tolerance(depth, make_view_rays(scene.camera, options.viewport));
    BatchCodec codec;
    std::array<EncodedBatch, parts> encoded;
    for (std::size_t part = 0; part < parts; ++part) {
        Batch batch;
        batch.number = 1;
        batch.view = {1, scene.camera, options.viewport};
        for (std::size_t i = part; i < rendered.size(); i += parts) {
            batch.framelets.push_back(to_display(rendered[i], scene.exposure));
            fit_layers(rendered[i], plane, tolerance, batch.shapes.emplace_back());
        }
        encoded[part] = codec.encode(batch);
    }
    FrameletPool pool(plane);
    Reprojector reprojector;
    Picture picture(options.viewport.width, options.viewport.height);
    std::vector<PixelRect> arrived, changed;
    std::uint64_t shown = 0;
    std::vector<double> rates;
    for (int round = 0; round < options.rounds; ++round) {
        rates.push_back(pictures / seconds_of([&] {
                            for (int i = 0; i < pictures; ++i) {
                                Batch batch = codec.decode(encoded[++shown % parts]);
                                batch.number = shown;
                                pool.insert(batch);
                                pool.newest().take_changed(arrived);
                                Camera camera = scene.camera;
                                camera.position += 1e-3f * static_cast<float>(i + 1) * depth * scene.camera.right();
                                reprojector.show(pool, arrived, camera, 0, {}, picture, changed);
                            }
                        }));
    }
    return {{"pictures_per_second", median(rates)}};
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
    measure_reprojection(scene, options, result["stages"]);
    result["viewer"] = measure_viewer(scene, options);

    json const& server = result["server"];
    std::printf("%s, %dx%d, %d threads, medians of %d rounds and the fastest one\n\n", scene.name.c_str(),
                options.viewport.width, options.viewport.height, result["threads"].get<int>(), options.rounds);
    std::printf("rendering, all threads        Msamples/s\n");
    std::printf("  bare Embree + shading loop  %8.2f\n", server["bare_samples_per_second"].get<double>() / 1e6);
    std::printf("  whole server                %8.2f   %.3f of the bare loop, %.2f B/sample on the wire\n\n",
                server["server_samples_per_second"].get<double>() / 1e6, server["ratio"].get<double>(),
                server["bytes_per_sample"].get<double>());
    std::printf("viewer, all threads           %8.1f pictures a second while a fifth of each arrives\n\n",
                result["viewer"]["pictures_per_second"].get<double>());
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
    for (auto const* stage : reprojections) {
        print(stage, stages[stage], "   (a pixel, camera moving)");
        print("  a fifth arrives for each", stages[stage]["arriving"], "");
    }
    return result;
}

} // namespace framelet::bench
