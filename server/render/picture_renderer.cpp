// Renders whole pictures: what a viewer converges to.
#include "server/render/picture_renderer.h"

#include <bit>

#include <tbb/parallel_for.h>

#include "common/color.h"
#include "common/error.h"
#include "server/render/display_framelet.h"
#include "server/render/framelet_renderer.h"
#include "server/render/visible_tiles.h"

namespace framelet {
namespace {

/// Averages a framelet's samples over each pixel that it covers.
void add_pixels(DisplayFramelet const& framelet, ImagePlane const& plane, int samples_per_side, Picture& picture) {
    PixelRect const rect = plane.tile_rect(framelet.tile);
    float const share = 1 / static_cast<float>(samples_per_side * samples_per_side);
    int const right = std::min(rect.right, picture.width);
    for (int y = rect.top; y < std::min(rect.bottom, picture.height); ++y) {
        for (int x = rect.left; x < right; ++x) {
            Vec3 sum(0);
            for (int j = 0; j < samples_per_side; ++j) {
                for (int i = 0; i < samples_per_side; ++i) {
                    std::size_t const sample =
                        morton_index(static_cast<std::uint32_t>((x - rect.left) * samples_per_side + i),
                                     static_cast<std::uint32_t>((y - rect.top) * samples_per_side + j));
                    sum +=
                        Vec3(linear_from_srgb_byte(framelet.red[sample]), linear_from_srgb_byte(framelet.green[sample]),
                             linear_from_srgb_byte(framelet.blue[sample]));
                }
            }
            std::uint8_t* const pixel = picture.row(y) + static_cast<std::ptrdiff_t>(x) * 4;
            for (int c = 0; c < 3; ++c) {
                pixel[c] = srgb_byte_from_linear(sum[c] * share);
            }
            pixel[3] = 255;
        }
    }
}

/// Renders each tile of a grid of `samples_per_side`^2 samples a pixel, in parallel; `add(framelet, plane)` takes it.
template <class Add>
void render_tiles(RenderScene const& scene, Camera const& camera, Viewport viewport, int samples_per_side,
                  Add const& add) {
    FRAMELET_CHECK(samples_per_side >= 1 && samples_per_side <= 8 && std::has_single_bit(unsigned(samples_per_side)));
    ImagePlane const plane(viewport);
    ViewRays const view = make_view_rays(camera, viewport);
    int const finer = std::countr_zero(static_cast<unsigned>(samples_per_side));
    std::vector<Tile> const tiles = visible_tiles(plane, plane.pixel_depth() + finer);
    tbb::parallel_for(std::size_t(0), tiles.size(), [&](std::size_t i) {
        Framelet framelet;
        render_framelet(scene, view, plane, tiles[i], framelet);
        add(framelet, plane);
    });
}

} // namespace

Picture render_picture(RenderScene const& scene, Camera const& camera, Viewport viewport,
                       DisplayTransform const& transform, int samples_per_side) {
    Picture picture(viewport.width, viewport.height);
    render_tiles(scene, camera, viewport, samples_per_side, [&](Framelet const& framelet, ImagePlane const& plane) {
        add_pixels(to_display(framelet, transform), plane, samples_per_side, picture);
    });
    return picture;
}

FloatImage render_radiance(RenderScene const& scene, Camera const& camera, Viewport viewport, int samples_per_side) {
    FloatImage picture(viewport.width, viewport.height);
    render_tiles(scene, camera, viewport, samples_per_side, [&](Framelet const& framelet, ImagePlane const& plane) {
        PixelRect const rect = plane.tile_rect(framelet.tile);
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            int const x = rect.left + static_cast<int>(morton_x(i)) / samples_per_side;
            int const y = rect.top + static_cast<int>(morton_y(i)) / samples_per_side;
            if (x < viewport.width && y < viewport.height) {
                picture.at(x, y) += Vec3(framelet.red[i], framelet.green[i], framelet.blue[i]) *
                                    (1 / static_cast<float>(samples_per_side * samples_per_side));
            }
        }
    });
    return picture;
}

} // namespace framelet
