// Places of the light cache: in the world, or in the frame of an instance that moves. In: a scene in its pose. Out:
// places, and where these are now.
#pragma once

#include "server/render/cache/light_record.h"
#include "server/render/prepared/prepared_scene.h"

namespace framelet {

/// The place of a point (world) of an instance, on the side of the unit vector `normal`.
LightPlace light_place(PreparedScene const& scene, std::uint32_t instance, Vec3 const& position, Vec3 const& normal);

/// How a frame lies in the world. Lengths in the frame of something that is scaled are about those of the world.
struct LightFrame {
    Mat3 rotation{1}; ///< world from frame, for directions
    Mat3 linear{1}; ///< world from frame
    Vec3 translation{0};
};
LightFrame light_frame(PreparedScene const& scene, std::uint32_t frame);

} // namespace framelet
