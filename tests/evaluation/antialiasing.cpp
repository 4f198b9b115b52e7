#include "tests/evaluation/antialiasing.h"

#include <cstdio>

#include <nlohmann/json.hpp>
#include <tbb/parallel_for.h>

#include "common/color.h"
#include "common/framelet_cache.h"
#include "common/reconstruction.h"
#include "server/render/framelet_renderer.h"
#include "server/schedule/tiling.h"
#include "tests/evaluation/bench_scene.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/reference.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// The seed that puts samples on the middles of their cells, and any other.
constexpr Seed middles = 0, jittered = 1;

Picture reconstructed(BenchScene const& scene, Viewport viewport, int levels, Seed seed) {
    ImagePlane const plane(viewport);
    Tiling const tiling = make_uniform_tiling(plane, plane.pixel_depth() + levels);
    std::vector<Framelet> rendered(tiling.tiles.size());
    render_framelets(*scene.render_scene, scene.camera, plane, tiling.tiles, seed, rendered);
    Batch batch;
    batch.number = 1;
    batch.view = {1, scene.camera, viewport};
    batch.framelets.resize(rendered.size());
    tbb::parallel_for(std::size_t{0}, rendered.size(),
                      [&](std::size_t i) { batch.framelets[i] = to_display(rendered[i], scene.exposure); });
    FrameletCache cache(plane);
    cache.insert(batch);
    Picture picture(viewport.width, viewport.height);
    std::vector<PixelRect> changed;
    cache.take_changed(changed);
    reconstruct(cache, changed, picture);
    return picture;
}

} // namespace

json compare_sample_places(AntialiasingStudy const& study) {
    std::printf("%dx%d, PSNR [dB] of samples on the middles of their cells, and jittered\n", study.viewport.width,
                study.viewport.height);
    std::printf("%-18s  1 a pixel        4 a pixel        16 a pixel\n", "");
    json rows;
    for (std::filesystem::path const& file : study.scenes) {
        auto const scene = load_bench_scene(file);
        pose_at(*scene, study.time);
        Picture const reference = render_reference(*scene, study.viewport, study.reference_side);
        json row = {{"scene", scene->name}};
        std::printf("%-18s", scene->name.c_str());
        for (int levels = 0; levels <= finest_levels; ++levels) {
            auto const psnr = [&](Seed seed) {
                return psnr_from_mse(
                    mean_squared_error(reconstructed(*scene, study.viewport, levels, seed), reference));
            };
            double const regular = psnr(middles), random = psnr(jittered);
            row["psnr"].push_back(
                {{"samples_per_pixel", 1 << (2 * levels)}, {"middles", regular}, {"jittered", random}});
            std::printf("  %5.2f  %5.2f   ", regular, random);
        }
        std::printf("\n");
        std::fflush(stdout);
        rows.push_back(std::move(row));
    }
    return rows;
}

} // namespace framelet::bench
