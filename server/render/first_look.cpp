#include "server/render/first_look.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "server/render/framelet_renderer.h"
#include "server/render/light/luminance.h"
#include "server/render/path/path_light.h"
#include "server/render/visible_tiles.h"

namespace framelet {
namespace {

Vec3 radiance(Framelet const& framelet, std::size_t i) {
    return {framelet.red[i], framelet.green[i], framelet.blue[i]};
}

/// The value below which so large a share of the values is; 0 where there are none.
float quantile(std::vector<float> values, double share) {
    if (values.empty()) {
        return 0;
    }
    auto const place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, place);
    return *place;
}

/// What log-average luminance asks for.
double exposure_of_average(std::vector<double> const& luminances, double mean) {
    constexpr double darkest = 0.02, brightest = 1, middle = 0.18;
    // Black is black: however dark, it says no more about the light than a hundredth of the mean.
    double sum = 0;
    for (double const luminance : luminances) {
        sum += std::log(std::max(luminance, 0.01 * mean));
    }
    double const average = std::exp(sum / static_cast<double>(luminances.size()));
    return average >= darkest && average <= brightest ? 1 : middle / average;
}

constexpr int rays_a_pixel = 16;

/// Sets each sample's radiance to the mean over its pixel: paths are anywhere in it as well.
void render_means(RenderScene const& scene, ViewRays const& view, ImagePlane const& plane, Tile tile, Framelet& out) {
    static_assert(rays_a_pixel == 16); // each of the tiles two levels below has a sixteenth of the samples, 16 times
    Framelet fine;
    for (std::uint32_t part = 0; part < 16; ++part) {
        render_framelet(scene, view, plane, {tile.code << 4 | part}, fine);
        for (std::size_t i = 0; i < 16; ++i) {
            Vec3 sum(0);
            for (std::size_t ray = 0; ray < 16; ++ray) {
                sum += radiance(fine, 16 * i + ray);
            }
            out.red[16 * part + i] = sum.r / 16;
            out.green[16 * part + i] = sum.g / 16;
            out.blue[16 * part + i] = sum.b / 16;
        }
    }
}

} // namespace

FirstLook take_first_look(RenderScene const& scene, Camera const& camera, PathLight const* light) {
    constexpr Viewport probe{64, 48};
    ImagePlane const plane(probe);
    std::vector<Tile> const tiles = visible_tiles(plane, plane.pixel_depth());
    FirstLook look(tiles.size());
    ViewRays const view = make_view_rays(camera, probe);
    tbb::parallel_for(std::size_t(0), tiles.size(), [&](std::size_t i) {
        render_framelet(scene, view, plane, tiles[i], look[i]); // for what is hit
        if (light != nullptr) {
            TileSums sums;
            TileLight brought;
            while (sums.paths < rays_a_pixel) {
                trace_tile(*light, view, plane, tiles[i], sums.paths, brought);
                add_path(brought, sums);
            }
            set_means(sums, look[i]);
        } else {
            render_means(scene, view, plane, tiles[i], look[i]);
        }
    });
    return look;
}

float auto_exposure(FirstLook const& look) {
    constexpr float whitest_hit = 0.9f, whitest_behind = 1, dimmest = 0.2f;
    constexpr float least_for_behind = 0.5f; // a window may be white
    std::vector<double> luminances;
    std::vector<float> hit, behind, all; // brightest channel
    for (Framelet const& framelet : look) {
        for (std::size_t i = 0; i < framelet_samples; ++i) {
            Vec3 const color = radiance(framelet, i);
            float const brightest = std::max({color.r, color.g, color.b});
            all.push_back(brightest);
            if (std::isfinite(framelet.depth[i])) {
                luminances.push_back(static_cast<double>(luminance(color)));
                hit.push_back(brightest);
            } else {
                behind.push_back(brightest);
            }
        }
    }
    double const mean = std::accumulate(luminances.begin(), luminances.end(), 0.0) /
                        std::max(1.0, static_cast<double>(luminances.size()));
    if (!(mean > 1e-12)) { // nothing is hit, or nothing can be seen at any exposure
        return 1;
    }
    auto exposure = static_cast<float>(exposure_of_average(luminances, mean));
    exposure = std::max(exposure, dimmest / std::max(quantile(all, 0.9), 1e-12f));
    if (10 * behind.size() > all.size()) {
        exposure = std::min(exposure, std::max(least_for_behind * exposure, whitest_behind / quantile(behind, 0.5)));
    }
    return std::min(exposure, whitest_hit / std::max(quantile(hit, 0.9), 1e-12f));
}

float auto_exposure(RenderScene const& scene, Camera const& camera, PathLight const* light) {
    return auto_exposure(take_first_look(scene, camera, light));
}

float shown_difference(FirstLook const& one, FirstLook const& other, DisplayTransform const& transform) {
    constexpr std::size_t block = 64; // samples that follow each other in Morton order are a square
    double sum = 0;
    std::size_t hits = 0;
    for (std::size_t tile = 0; tile < std::min(one.size(), other.size()); ++tile) {
        for (std::size_t begin = 0; begin < framelet_samples; begin += block) {
            Vec3 a(0), b(0);
            std::size_t n = 0;
            for (std::size_t i = begin; i < begin + block; ++i) {
                if (std::isfinite(one[tile].depth[i])) {
                    a += radiance(one[tile], i);
                    b += radiance(other[tile], i);
                    ++n;
                }
            }
            if (n > 0) {
                float const share = 1 / static_cast<float>(n);
                sum += static_cast<double>(n) * static_cast<double>(std::abs(display_luma(a * share, transform) -
                                                                             display_luma(b * share, transform)));
                hits += n;
            }
        }
    }
    return hits > 0 ? static_cast<float>(255 * sum / static_cast<double>(hits)) : 0;
}

} // namespace framelet
