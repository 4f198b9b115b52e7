#include "server/render/visibility.h"

#include <gtest/gtest.h>

#include "scene_builder.h"

namespace framelet {
namespace {

using namespace test;

constexpr Viewport viewport{50, 38};
Camera const camera = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 0.5f);

std::vector<float> look(Scene const& scene, RayGrid const& grid) {
    RenderScene const rendered(scene, std::nullopt);
    std::vector<float> seen;
    std::uint64_t const rays = render_visibility(rendered, make_view_rays(camera, viewport), viewport, grid, seen);
    EXPECT_EQ(rays, seen.size());
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(grid.columns(viewport) * grid.rows(viewport)));
    return seen;
}

/// A wall at a depth of 10 metres that fills the left half of the picture.
Scene half_wall(Material const& material) {
    Scene scene;
    scene.materials = {material};
    add(scene, quad({-50, -50, 0}, {50, 0, 0}, {0, 100, 0}, 0));
    return scene;
}

TEST(Visibility, IsTheInverseDepthOfWhatIsNearest) {
    Scene scene = half_wall(matte(Vec3(0.5f)));
    add(scene, quad({-50, 0, 5}, {100, 0, 0}, {0, 50, 0}, 0)); // the upper half, at 5 metres
    for (int const spacing : {4, 8, 16}) {
        RayGrid const grid = cell_grid(4, spacing, 1);
        std::vector<float> const seen = look(scene, grid);
        for (int row = 0; row < grid.rows(viewport); ++row) {
            for (int column = 0; column < grid.columns(viewport); ++column) {
                Vec2 const place = grid.position(column, row);
                float const expected = place.y < 19 ? 0.2f : place.x < 25 ? 0.1f : 0.0f;
                EXPECT_NEAR(seen[static_cast<std::size_t>(row * grid.columns(viewport) + column)], expected, 1e-5f)
                    << place.x << ' ' << place.y;
            }
        }
    }
}

TEST(Visibility, IsNotKnownOfWhatIsSeeThroughOrSeenFromItsBack) {
    Material glass = matte(Vec3(0.5f));
    glass.transmission = 1;
    RayGrid const grid = cell_grid(4, 4, 0);
    EXPECT_EQ(look(half_wall(glass), grid).front(), unknown_inverse_depth);
    Scene turned;
    turned.materials = {matte(Vec3(0.5f))};
    turned.materials[0].double_sided = false;
    add(turned, quad({0, -50, 0}, {-50, 0, 0}, {0, 100, 0}, 0));
    EXPECT_EQ(look(turned, grid).front(), unknown_inverse_depth);
}

TEST(Visibility, OfAPictureWithoutPlacesIsNothing) {
    EXPECT_TRUE(look(half_wall(matte(Vec3(0.5f))), {Vec2(60, 60), 64}).empty());
}

} // namespace
} // namespace framelet
