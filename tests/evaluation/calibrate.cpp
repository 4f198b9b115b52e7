#include "tests/evaluation/calibrate.h"

#include <numeric>
#include <random>

#include <tbb/global_control.h>

#include "common/held/framelet_cache.h"
#include "common/held/framelet_pool.h"
#include "common/picture/reconstruction.h"
#include "common/picture/reprojector.h"
#include "protocol/codec/batch_codec.h"
#include "server/render/display_framelet.h"
#include "server/stream/flow/qp_choice.h"
#include "server/stream/layers/shape_feed.h"
#include "tests/evaluation/codecs/h264_codec.h"
#include "tests/evaluation/methods/kd_leaves.h"
#include "tests/evaluation/methods/tsar_server.h"
#include "tests/evaluation/methods/tsar_viewer.h"
#include "tests/evaluation/methods/whole_frame.h"
#include "tests/evaluation/response_cost.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {
namespace {

/// Pictures of the scene a thirtieth of a second apart, for the codecs that look back.
std::vector<Picture> moving_pictures(BenchScene& scene, Viewport viewport, int count) {
    std::vector<Picture> pictures;
    for (int i = 0; i < count; ++i) {
        pose_at(scene, i / 30.0);
        pictures.push_back(render_picture(*scene.render_scene, scene.camera, viewport, scene.exposure, 1));
    }
    pose_at(scene, 0);
    return pictures;
}

void calibrate_rendering(BenchScene& scene, ImagePlane const& plane, int rounds, std::vector<Framelet>& rendered,
                         CostTable& costs) {
    auto const tiles = make_uniform_tiling(plane, plane.pixel_depth()).tiles;
    rendered.resize(tiles.size());
    std::vector<Vec2> positions;
    for (Tile const tile : tiles) {
        PixelRect const rect = plane.tile_rect(tile);
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            positions.push_back(Vec2(rect.left, rect.top) + Vec2(morton_x(i), morton_y(i)) + 0.5f);
        }
    }
    std::mt19937 random(1);
    std::shuffle(positions.begin(), positions.end(), random);
    std::vector<float> const spacings(positions.size(), 1.0f);
    std::vector<Vec3> radiance(positions.size());
    ViewRays const rays = make_view_rays(scene.camera, plane.viewport());
    std::vector<double> coherent, incoherent;
    for (int round = 0; round < rounds; ++round) {
        std::uint64_t segments = 0;
        double seconds =
            seconds_of([&] { segments = render_framelets(*scene.render_scene, scene.camera, plane, tiles, rendered); });
        coherent.push_back(1e9 * seconds / static_cast<double>(segments));
        seconds =
            seconds_of([&] { segments = render_samples(*scene.render_scene, rays, positions, spacings, radiance); });
        incoherent.push_back(1e9 * seconds / static_cast<double>(segments));
    }
    costs.coherent_segment = median(coherent);
    costs.incoherent_segment = median(incoherent);
}

/// Median cost of `work`, which does `units` units, in nanoseconds a unit.
template <class Work>
double cost(int rounds, double units, Work&& work) {
    std::vector<double> all;
    for (int round = 0; round < rounds; ++round) {
        all.push_back(1e9 * seconds_of(work) / units);
    }
    return median(all);
}

/// Measures coding with loss where prediction costs most: every framelet has moved to where another one was before, so
/// far that the motion search for it takes as long as one in vain.
void calibrate_prediction(Batch batch, int rounds, CostTable& costs) {
    double const samples = static_cast<double>(batch.framelets.size() * framelet_samples);
    batch.qp.assign(batch.framelets.size(), most_loss);
    BatchCodec codec;
    BatchMemory sent, received;
    std::vector<double> encode, decode;
    for (int round = -1; round < rounds; ++round) { // round -1 is not counted: it is predicted from a grey picture
        Tile const first = batch.framelets.front().tile;
        for (std::size_t i = 0; i + 1 < batch.framelets.size(); ++i) {
            batch.framelets[i].tile = batch.framelets[i + 1].tile;
        }
        batch.framelets.back().tile = first;
        EncodedBatch encoded;
        double const encoding = seconds_of([&] { encoded = codec.encode(batch, &sent); });
        double const decoding = seconds_of([&] { codec.decode(encoded, &received); });
        if (round >= 0) {
            encode.push_back(1e9 * encoding / samples);
            decode.push_back(1e9 * decoding / samples);
        }
    }
    costs.encode_lossy_sample = median(encode);
    costs.decode_lossy_sample = median(decode);
}

void calibrate_framelets(BenchScene& scene, ImagePlane const& plane, int rounds, std::vector<Framelet> const& rendered,
                         CostTable& costs) {
    Viewport const viewport = plane.viewport();
    double const samples = static_cast<double>(rendered.size() * framelet_samples);
    double const pixels = static_cast<double>(viewport.width) * viewport.height;
    Batch batch;
    batch.view = {1, scene.camera, viewport};
    batch.framelets.resize(rendered.size());
    costs.display_sample = cost(rounds, samples, [&] {
        std::transform(rendered.begin(), rendered.end(), batch.framelets.begin(),
                       [&](Framelet const& framelet) { return to_display(framelet, scene.exposure); });
    });
    BatchCodec codec;
    EncodedBatch encoded;
    Batch decoded;
    costs.encode_sample = cost(rounds, samples, [&] { encoded = codec.encode(batch); });
    costs.decode_sample = cost(rounds, samples, [&] { decoded = codec.decode(encoded); });
    calibrate_prediction(batch, rounds, costs);

    FrameletCache cache(plane);
    Picture picture(viewport.width, viewport.height);
    std::vector<PixelRect> changed;
    std::vector<double> insertion, coarse, fine;
    for (int round = 0; round < rounds; ++round) {
        ++decoded.number;
        insertion.push_back(seconds_of([&] { cache.insert(decoded); }));
        cache.take_changed(changed);
        coarse.push_back(seconds_of([&] { reconstruct(cache, changed, picture); }));
    }
    // Insert the same colours once more, a level finer: four framelets where there was one.
    Batch finer = decoded;
    finer.framelets.clear();
    for (DisplayFramelet framelet : decoded.framelets) {
        Tile const tile = framelet.tile;
        for (std::uint32_t quadrant = 0; quadrant < 4; ++quadrant) {
            framelet.tile = tile.child(quadrant);
            if (plane.is_visible(framelet.tile)) {
                finer.framelets.push_back(framelet);
            }
        }
    }
    for (int round = 0; round < rounds; ++round) {
        ++finer.number;
        cache.insert(finer);
        cache.take_changed(changed);
        fine.push_back(seconds_of([&] { reconstruct(cache, changed, picture); }));
    }
    costs.cache_sample = 1e9 * median(insertion) / samples;
    costs.reconstruct_pixel = 1e9 * median(coarse) / pixels;
    double const fine_samples = static_cast<double>(finer.framelets.size() * framelet_samples);
    costs.reconstruct_fine_sample = 1e9 * std::max(median(fine) - median(coarse), 0.1 * median(coarse)) / fine_samples;
    costs.place_pixel = cost(rounds, pixels, [&] {
        for (DisplayFramelet const& framelet : batch.framelets) {
            write_samples(framelet, picture);
        }
    });
}

/// Measures the fitting of shapes of whole framelets, and the picture that another camera sees of them.
void calibrate_reprojection(BenchScene const& scene, ImagePlane const& plane, int rounds,
                            std::vector<Framelet> const& rendered, CostTable& costs) {
    Viewport const viewport = plane.viewport();
    Batch batch;
    batch.number = 1;
    batch.view = {1, scene.camera, viewport};
    for (Framelet const& framelet : rendered) {
        batch.framelets.push_back(to_display(framelet, scene.exposure));
    }
    ShapeFeed feed;
    std::vector<std::uint8_t> const all(rendered.size(), 1);
    ViewRays const rays = make_view_rays(scene.camera, viewport);
    costs.shape_sample = cost(rounds, static_cast<double>(rendered.size() * framelet_samples),
                              [&] { feed.fit(rendered, all, rays, plane, 0, batch.shapes); });
    FrameletPool pool(plane);
    pool.insert(batch, {});
    Picture picture(viewport.width, viewport.height);
    std::vector<PixelRect> changed, repainted;
    pool.newest().take_changed(changed);
    Reprojector reprojector;
    Camera camera = scene.camera;
    costs.reproject_pixel = cost(rounds, static_cast<double>(viewport.width) * viewport.height, [&] {
        camera.position += 0.01f * camera.right();
        reprojector.show(pool, changed, camera, 0, {}, picture, repainted);
        changed.clear();
    });
}

/// Measures the response on a scene that moves, as a server of ten frames a second sees it.
void calibrate_response(BenchScene& scene, Viewport viewport, int rounds, CostTable& costs) {
    double const rate = 10.0 * viewport.width * viewport.height;
    ResponseCost const cost = response_cost(scene, viewport, rate, 0.1 * rounds);
    costs.plan_region = 1e9 * cost.plan / static_cast<double>(cost.cycles * cost.regions);
    costs.learn_sample = 1e9 * cost.learn / static_cast<double>(cost.samples);
}

void calibrate_afr(Viewport viewport, int rounds, CostTable& costs) {
    KdLeaves leaves(viewport, 64);
    std::mt19937_64 random(1);
    // A step takes about as many samples as there are leaves.
    double time = 0;
    costs.afr_sample = cost(rounds * 8, static_cast<double>(leaves.size()), [&] {
        std::size_t const count = leaves.size();
        time += 1.0 / 120;
        for (std::size_t i = 0; i < count; ++i) {
            std::size_t const leaf = random() % leaves.size();
            leaves.add(leaf, time, static_cast<float>(random() % 256) / 255.0f * (leaf % 2 == 0 ? 1.0f : 0.1f));
        }
        leaves.adapt(count / 64);
    });
}

/// Bytes of one of x264's frames at 5 Mbit/s and 30 frames a second: the more bytes, the longer x264 takes.
constexpr double streamed_frame_bytes = 5e6 / 8 / 30;
/// Measures the stages of the density response, each alone, on a picture that has just moved.
void calibrate_density_response(ImagePlane const& plane, std::vector<Framelet> const& rendered, int rounds,
                                CostTable& costs) {
    std::vector<std::array<float, framelet_samples>> luma;
    for (Framelet const& framelet : rendered) {
        std::transform(framelet.green.begin(), framelet.green.end(), luma.emplace_back().begin(),
                       [](float radiance) { return std::min(radiance, 1.0f); });
    }
    constexpr std::size_t blocks = 16;
    std::vector<HaarHistory> histories(luma.size());
    std::vector<RateError> errors(luma.size() * blocks);
    costs.estimate_sample = cost(rounds, static_cast<double>(luma.size() * framelet_samples), [&] {
        for (std::size_t i = 0; i < luma.size(); ++i) {
            estimate_haar(luma[i], histories[i], template_interval, haar_templates,
                          std::span(errors).subspan(i * blocks, blocks));
        }
    });
    DensityField density = make_uniform_density(plane.max_depth(), {1, 10});
    std::vector<std::uint32_t> elements(density.size());
    std::iota(elements.begin(), elements.end(), 0u);
    errors.resize(elements.size());
    // The errors have both signs, so that density is transported.
    std::mt19937 random(1);
    for (RateError& error : errors) {
        error = {static_cast<float>(random() % 256) / 128 - 1, static_cast<float>(random() % 256) / 128 - 1};
    }
    ResponseParameters const parameters{{{1.0 / 64, 1}, {16, 80}}, 0.1, 10, 0};
    ResponseScratch scratch;
    double const count = static_cast<double>(elements.size());
    costs.respond_element = cost(rounds, count, [&] { respond(density, elements, errors, parameters, scratch); });
    costs.tiling_element =
        cost(rounds, count, [&] { make_density_tiling(plane, density.space, density.depth, framelet_samples); });
}

/// Measures the reconstruction of [Stephens 2011]: a picture of one sample a pixel, and the same colours a level finer.
void calibrate_blending(BenchScene const& scene, ImagePlane const& plane, std::vector<Framelet> const& rendered,
                        int rounds, CostTable& costs) {
    std::vector<DisplayFramelet> coarse, fine;
    for (Framelet const& framelet : rendered) {
        DisplayFramelet displayed = coarse.emplace_back(to_display(framelet, scene.exposure));
        for (std::uint32_t quadrant = 0; quadrant < 4; ++quadrant) {
            displayed.tile = framelet.tile.child(quadrant);
            fine.push_back(displayed);
        }
    }
    BlendWork few, many;
    TsarViewer coarse_viewer(plane), fine_viewer(plane);
    double time = 0;
    double const few_seconds = 1e-9 * cost(rounds, 1, [&] { few = coarse_viewer.show(coarse, ++time, 0); });
    double const many_seconds = 1e-9 * cost(rounds, 1, [&] { many = fine_viewer.show(fine, ++time, 0); });
    costs.blend_contribution =
        1e9 * std::max(many_seconds - few_seconds, 0.1 * few_seconds) / (many.contributions - few.contributions);
    double const rest = 1e9 * few_seconds - few.contributions * costs.blend_contribution;
    costs.blend_pixel = std::max(rest, 0.1e9 * few_seconds) / few.pixels;
}

void calibrate_h264(BenchScene& scene, Viewport viewport, int rounds, CostTable& costs) {
    auto const pictures = moving_pictures(scene, viewport, std::max(rounds, 8));
    double const pixels = static_cast<double>(viewport.width) * viewport.height;
    H264Encoder encoder(viewport.width, viewport.height, 30);
    H264Decoder decoder;
    std::vector<double> h264_in, h264_out;
    Picture decoded;
    for (Picture const& picture : pictures) {
        std::vector<std::byte> unit;
        h264_in.push_back(seconds_of([&] { unit = encoder.encode(picture, streamed_frame_bytes); }));
        h264_out.push_back(seconds_of([&] { decoder.decode(unit, decoded); }));
    }
    costs.h264_encode_pixel = 1e9 * median(h264_in) / pixels;
    costs.h264_decode_pixel = 1e9 * median(h264_out) / pixels;
}

} // namespace

CostTable calibrate(BenchScene& scene, Viewport viewport, int rounds) {
    tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
    pose_at(scene, 0);
    ImagePlane const plane(viewport);
    CostTable costs;
    std::vector<Framelet> rendered;
    calibrate_rendering(scene, plane, rounds, rendered, costs);
    calibrate_framelets(scene, plane, rounds, rendered, costs);
    calibrate_reprojection(scene, plane, rounds, rendered, costs);
    calibrate_response(scene, viewport, rounds, costs);
    calibrate_afr(viewport, rounds, costs);
    calibrate_density_response(plane, rendered, rounds, costs);
    calibrate_blending(scene, plane, rendered, rounds, costs);
    calibrate_h264(scene, viewport, rounds, costs);
    return costs;
}

} // namespace framelet::bench
