#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/framelet/reprojection.h"
#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

constexpr float inverse_depth = 0.2f;

Camera sideways(double metres) {
    Camera camera = front();
    camera.position += static_cast<float>(metres) * camera.right();
    return camera;
}

/// Metres that the camera moves sideways for everything at `inverse_depth` to move by a pixel in the picture.
double metres_per_pixel() {
    ViewTransform const transform =
        make_view_transform(make_view_rays(front(), viewport), make_view_rays(sideways(1), viewport));
    glm::dvec3 const at = transform.map(160, 96, static_cast<double>(inverse_depth));
    return 1 / (at.x / at.z - 160);
}

/// A picture seen by `camera`, as framelets of one sample a pixel at one depth.
FrameletPool hold_picture(Picture const& picture, Camera const& camera) {
    ImagePlane const plane(viewport);
    auto const shade = [&](float x, float y) {
        std::uint8_t const* const pixel = picture.row(static_cast<int>(y)) + 4 * static_cast<int>(x);
        bool const inside = static_cast<int>(x) < viewport.width && static_cast<int>(y) < viewport.height;
        return inside ? std::array{pixel[0], pixel[1], pixel[2]} : std::array<std::uint8_t, 3>{};
    };
    Batch batch = make_batch(plane, 1, {});
    for (Tile const tile : visible_tiles(plane, plane.pixel_depth())) {
        batch.framelets.push_back(shade_framelet(plane, tile, shade));
    }
    batch.view.camera = camera;
    FrameletShape shape;
    shape.layer_count = 1;
    shape.layers[0].at = inverse_depth;
    batch.shapes.assign(batch.framelets.size(), shape);
    FrameletPool pool(plane);
    pool.insert(batch, {});
    return pool;
}

/// A line one pixel wide, which sideways is an impulse.
Picture impulse() {
    Picture picture(viewport.width, viewport.height);
    for (int y = 0; y < viewport.height; ++y) {
        std::fill_n(picture.row(y) + 4 * 160, 3, std::uint8_t{255});
    }
    return picture;
}

/// Variance, pixels^2, by which `filter_pixels` spreads an outline: an eighth of it goes to either side.
constexpr double filter_spread = 0.25;

/// Variance of the light along the impulse's row, pixels^2.
double spread(Picture const& picture) {
    double light = 0, first = 0, second = 0;
    for (int x = 120; x < 200; ++x) {
        double const value = picture.row(96)[4 * x];
        light += value * value;
        first += value * value * x;
        second += value * value * x * x;
    }
    return second / light - first * first / (light * light);
}

/// [Scherzer 2012] section 4.2: n bilinear resamplings at a fractional velocity v blur by n v (1 - v); and the filter
/// each time, until too little of an outline is left.
TEST(RepeatedResampling, OfPicturesBlursMoreEveryTime) {
    for (double const v : {0.5, 0.25, 0.1}) {
        Picture picture = impulse();
        for (int n = 1; n <= 8; ++n) {
            FrameletPool const pool = hold_picture(picture, front());
            picture = show(pool, sideways(v * metres_per_pixel()), 0).picture;
            double const least = n * v * (1 - v);
            EXPECT_GT(spread(picture), 0.97 * least - 0.01) << v << " " << n;
            EXPECT_LT(spread(picture), 1.03 * (least + n * filter_spread) + 0.01) << v << " " << n;
        }
    }
}

/// What is held is always resampled from the original: n steps blur as one does, by that step's fraction.
TEST(RepeatedResampling, OfWhatIsHeldBlursOnce) {
    FrameletPool const pool = hold_picture(impulse(), front());
    for (double const v : {0.5, 0.25, 0.1}) {
        Reprojector reprojector;
        Picture picture(viewport.width, viewport.height);
        std::vector<PixelRect> repainted;
        for (int n = 1; n <= 40; ++n) {
            reprojector.show(pool, {}, sideways(n * v * metres_per_pixel()), 0, {}, picture, repainted);
            double const fraction = n * v - std::floor(n * v);
            EXPECT_NEAR(spread(picture), fraction * (1 - fraction) + filter_spread, 0.01) << v << " " << n;
        }
    }
}

} // namespace
} // namespace framelet
