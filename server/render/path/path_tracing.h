// Follows paths of light through a scene: the reference for all other light. In: rays, what they cover, random numbers.
// Out: unbiased estimates of radiance.
//
// Simulated: any number of diffuse and glossy bounces; light of suns and lamps (hard, or with a size), emissive
// triangles, the environment as far as nothing stands before it; cut-outs, alpha blending and transmission, straight
// through, as shadow rays and the direct renderer have them. Unlit surfaces send their colour to whatever sees them.
// Not simulated: caustics of lights without a size, refraction, volumes, subsurface scattering. Not counted: occlusion
// maps and the share of the default sky that reaches surfaces (`Environment::default_sky`), which stand for shadows
// that are traced here; highlights of hard lights are as wide as `sharpest_highlight`, as in brdf.h. What is nearer to
// the middle of a hard lamp than `lamp_core` throws no shadow. Backs that are not drawn stop bounces as they stop
// shadow rays; cameras alone see through them. Slow to converge: caustics, and what emissive triangles light from near.
#pragma once

#include "server/render/path/area_lights.h"
#include "server/render/path/lamp_rays.h"
#include "server/render/path/path_options.h"
#include "server/render/path/sky_table.h"

namespace framelet {

/// What paths sample of a scene in the pose that it had when this was made or updated last.
struct PathScene {
    explicit PathScene(PreparedScene const& prepared)
        : scene(prepared), area_lights(prepared), lamp_rays(prepared.lights), sky(prepared.environment) {}
    void update() {
        area_lights = AreaLights(scene);
        lamp_rays = LampRays(scene.lights);
    }

    PreparedScene const& scene;
    AreaLights area_lights;
    LampRays lamp_rays;
    SkyTable sky;
};

/// The random numbers of sixteen paths. The first pair of dimensions is the caller's, for the point of the picture.
struct PathNumbers {
    LaneIndices pixel_seed, sample;
};

/// Sets the radiance that comes along each ray of `active`, one path a lane: finite, >= 0. `rays` is scratch
/// afterwards.
void trace_paths(PathScene const& scene, PathOptions const& options, RayPacket& rays, LaneMask active,
                 Footprint footprint, PathNumbers const& numbers, LaneVec3& radiance);

/// What arrives at places of surfaces from all around, but straight from punctual lights: one path of each lane.
struct GatheredLanes {
    LaneVec3 all; ///< irradiance / pi
    LaneVec3 reflected; ///< the part of `all` that comes from surfaces
    LaneVec3 lean; ///< luminance * unit direction, world
    LaneFloats open; ///< 1: the first ray has met nothing
    LaneFloats nearness; ///< 1 / metres to what it has met, else 0
};

/// Gathers light at places (world; a little off their surface) about unit normals. `footprint` is that of the rays that
/// leave them.
void gather_light(PathScene const& scene, PathOptions const& options, LaneVec3 const& position, LaneVec3 const& normal,
                  LaneMask active, Footprint footprint, PathNumbers const& numbers, GatheredLanes& out);

} // namespace framelet
