// What the tests of the mirror look at: a small picture, cameras before it, and a wall. In: positions. Out: views,
// cells.
#pragma once

#include <vector>

#include "server/sampling/mirror/mirror.h"
#include "tests/sampling/rendered_planes.h"

namespace framelet::test {

inline constexpr Viewport viewport{128, 96};
inline ImagePlane const plane{viewport};
inline BodyMotions const no_motions;

inline Camera camera_at(Vec3 position) {
    Camera camera;
    camera.position = position;
    return camera;
}
inline MirrorView view_at(Vec3 position, SceneTime time = 0) {
    return {make_view_rays(camera_at(position), viewport), time};
}
/// Size of a pixel, metres, of what is a metre away.
inline float pixel_size() {
    return view_at(Vec3(0)).rays.direction_dx.x;
}
inline Seen wall(float, float) {
    return {};
}
inline std::vector<Cell> cells_of(Mirror const& mirror) {
    std::vector<Cell> cells;
    for (int row = 0; row < mirror.rows(); ++row) {
        for (int column = 0; column < mirror.columns(); ++column) {
            cells.push_back(mirror.cell(column, row));
        }
    }
    return cells;
}

} // namespace framelet::test
