// How a surface scatters light, one point at a time: the GGX lobe of brdf.h and a Lambertian share. Both together
// return of uniform light exactly what `ambient_shares` says: all of it where the surface is white.
#pragma once

#include "server/render/light/split_sum.h"
#include "server/render/surface/surface.h"

namespace framelet {

struct Scattering {
    Mat3 frame; ///< world from a space whose z is the shading normal
    Vec3 view; ///< unit, in that space
    Vec3 f0; ///< reflectance at normal incidence
    Vec3 diffuse; ///< albedo of the Lambertian share, with what bounces between facets
    float alpha; ///< (perceptual roughness)^2
    float specular_chance; ///< with which the GGX lobe is sampled
};

/// Lobes of a lane. `lambertian`: base colour * (1 - metallic) is all that is reflected.
Scattering scattering_of(SurfacePacket const& surfaces, int lane, SplitSumTable const& split_sum, bool lambertian);

/// The share of uniform light that is returned.
Vec3 albedo(Scattering const& scattering, SplitSumTable const& split_sum);

struct Scattered {
    Vec3 reflected{0}; ///< BSDF * cosine
    float density = 0; ///< with which `sample_scattering` finds the direction, 1 / sr
};

/// Of light from the unit vector `to_light` (world). `least_alpha`: of the GGX lobe, for light from a point.
Scattered scattered(Scattering const& scattering, Vec3 const& to_light, float least_alpha = 0);

/// A unit direction to light (world), from two random numbers and one that chooses the lobe.
Vec3 sample_scattering(Scattering const& scattering, Vec2 random, float choice);

} // namespace framelet
