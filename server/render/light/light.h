// Says where the light of punctual lights (KHR_lights_punctual) comes from at sixteen points, and how much it is.
#pragma once

#include "server/render/packet.h"
#include "server/scene/motion/animation.h"

namespace framelet {

/// A point light gets no brighter nearer than this, metres: inverse square would have no bound.
inline constexpr float lamp_core = 1e-3f;

struct RenderLight {
    LightType type = LightType::directional;
    Vec3 intensity{0}; ///< candela, or lux for directional lights, per colour
    Vec3 position{0}; ///< world
    Vec3 towards{0, 1, 0}; ///< world, unit; against the direction in which it shines
    float inverse_range = 0; ///< 1 / metres; 0: unlimited
    float cone_scale = 0, cone_offset = 1; ///< spot: (cosine * scale + offset), clamped and squared, weighs the cone
};

/// A light of the scene where this pose has it. Numbers beyond any use are limited, so that no sum overflows.
RenderLight make_light(Light const& light, ScenePose const& pose);

/// The sun of scenes that bring no light: from the upper right, in front.
RenderLight default_sun();

/// Light arriving at sixteen points.
struct ArrivingLight {
    LaneVec3 to_light; ///< world, unit
    LaneFloats distance; ///< metres; +infinity for directional lights
    LaneFloats irradiance; ///< for `intensity` 1: what falls on the surface, its cosine included
};

/// Returns the lanes at which the light is above the horizon and in reach.
LaneMask arriving_light(RenderLight const& light, LaneVec3 const& position, LaneVec3 const& normal, LaneMask active,
                        ArrivingLight& out);

} // namespace framelet
