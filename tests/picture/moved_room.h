// A room, held as framelets from one camera and shown from another: what tests of the Reprojector start from.
#pragma once

#include <vector>

#include "common/picture/reprojector.h"
#include "tests/picture/analytic_scene.h"
#include "tests/picture/synthetic_framelets.h"

namespace framelet {

inline constexpr Viewport viewport{320, 192};

inline Camera front() {
    return look_at(Vec3(0, 1.5f, 6), Vec3(0, 1, 0), Vec3(0, 1, 0), 0.8f);
}

/// A floor, a wall behind and a board in front of it.
inline AnalyticScene room() {
    AnalyticScene scene;
    scene.quads.push_back({{-8, 0, -3}, {16, 0, 0}, {0, 0, 16}, waves(12, 6)});
    scene.quads.push_back({{-8, 0, -3}, {16, 0, 0}, {0, 3, 0}, waves(12, 2)});
    scene.quads.push_back({{-0.8, 0.3, 1}, {1.4, 0, 0.3}, {0, 1.4, 0}, waves(2, 2)});
    return scene;
}

/// The poses of a body that goes to the right, a metre a second.
inline BodyTrack moving_track() {
    BodyTrack track{5, 0, {}};
    for (int i = 0; i <= 4 * body_keys_per_second; ++i) {
        track.keys.push_back({Vec3(static_cast<float>(i) / body_keys_per_second, 0, 0), {1, 0, 0, 0}, Vec3(1)});
    }
    return track;
}

/// The room whose board is that body.
inline AnalyticScene moving_room() {
    AnalyticScene scene = room();
    scene.motions.extend(moving_track());
    scene.quads[2].body = 5;
    return scene;
}

struct Shown {
    Picture picture{viewport.width, viewport.height};
    std::vector<float> inverse_depth;
    double hole_share = 0;
};

inline Shown show(FrameletPool const& pool, Camera const& camera, SceneTime time, BodyMotions const& motions = {}) {
    Shown out;
    Reprojector reprojector;
    std::vector<PixelRect> repainted;
    reprojector.show(pool, {}, camera, time, motions, out.picture, repainted);
    out.inverse_depth.assign(reprojector.inverse_depth().begin(), reprojector.inverse_depth().end());
    out.hole_share = reprojector.hole_share();
    return out;
}

inline FrameletPool filled(AnalyticScene const& scene, Camera const& camera, int levels, SceneTime time = 0,
                           bool all_outliers = false) {
    ImagePlane const plane(viewport);
    FrameletPool pool(plane);
    pool.insert(scene.batch(plane, 1, camera, time, visible_tiles(plane, plane.pixel_depth() + levels), all_outliers),
                scene.motions);
    return pool;
}

inline std::size_t at(int x, int y) {
    return static_cast<std::size_t>(y) * viewport.width + static_cast<std::size_t>(x);
}

} // namespace framelet
