// Pictures that take every way through the painters, for comparing those of one processor with those of another.
#pragma once

#include <cstdint>
#include <vector>

#include "common/picture/reconstruction.h"
#include "common/picture/scene_smoother.h"
#include "tests/picture/moved_room.h"

namespace framelet {

/// The bytes of all pictures, one after another.
inline std::vector<std::uint8_t> painted_bytes() {
    std::vector<std::uint8_t> out;
    auto const add = [&out](Picture const& picture) {
        out.insert(out.end(), picture.rgba.begin(), picture.rgba.end());
    };
    Camera const aside = look_at(Vec3(0.35f, 1.7f, 5.7f), Vec3(0.05f, 0.95f, 0), Vec3(0, 1, 0), 0.8f);
    AnalyticScene scene = room();
    BodyTrack track{5, 0, {}};
    for (int i = 0; i <= 60; ++i) {
        auto const time = static_cast<float>(i) / body_keys_per_second;
        track.keys.push_back({Vec3(0.6f * time, 0, 0), glm::angleAxis(0.7f * time, Vec3(0, 0, 1)), Vec3(1)});
    }
    scene.motions.extend(track);
    scene.quads[2].body = 5;
    scene.quads[1].velocity = {0.4, 0, 0.1};
    ImagePlane const plane(viewport);
    for (int const levels : {-2, 0, 1}) { // coarser than pixels, and finer
        FrameletPool const pool = filled(scene, front(), levels, 0.2);
        add(show(pool, aside, 0.6, scene.motions).picture);
        Picture still(viewport.width, viewport.height);
        reconstruct(pool.newest(), std::vector<PixelRect>{{0, 0, viewport.width, viewport.height}}, still);
        add(still);
    }
    add(show(filled(scene, front(), 0, 0.2, true), aside, 0.6, scene.motions).picture); // samples by themselves
    // Two moments, between which the scene is smoothed.
    FrameletPool pool(plane);
    SceneSmoother smoother(plane);
    std::vector<PixelRect> changed;
    Picture smooth(viewport.width, viewport.height);
    for (std::uint64_t number = 1; number <= 3; ++number) {
        auto const time = 0.1 * static_cast<double>(number);
        Batch const batch = scene.batch(plane, number, front(), time, visible_tiles(plane, plane.pixel_depth() - 1));
        pool.insert(batch, scene.motions);
        smoother.insert(batch, scene.motions);
        smoother.show(pool, {}, aside, time - 0.05, 0.1, scene.motions, smooth, changed);
        add(smooth);
    }
    return out;
}

} // namespace framelet
