// Light from all around: an equirectangular map, prefiltered for rough surfaces.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "common/image.h"
#include "server/render/light/octahedral_map.h"

namespace framelet {

/// Prefiltered environment. Immutable after construction; look-ups are pure.
/// Direction to map: u = 0.5 + atan2(x, -z) / 2pi (so -Z, where a default camera looks, is the middle), v = acos(y) /
/// pi. It lights surfaces without regard to what stands between: only occlusion maps darken it.
class Environment {
public:
    /// Prefilters `radiance`, which has cd/m^2 or any unit proportional to the lights' (width = 2 * height is usual,
    /// not required).
    explicit Environment(FloatImage const& radiance);

    /// The default surroundings: a clear sky gradient over a neutral ground.
    /// `brightness` scales it; `light_share` is the part of it that reaches surfaces: less than 1 stands for what walls
    /// and trees would keep off, as environment light is not shadowed.
    static Environment default_sky(float brightness = 1, float light_share = 1);
    /// An environment of the same radiance from everywhere.
    static Environment uniform(Vec3 radiance);
    /// Reads .hdr or .exr (anything OpenImageIO knows). Throws InputError.
    static Environment load(std::filesystem::path const& file);

    /// Radiance seen by a ray that hits nothing; `footprint` is its angular width in radians (picks the level).
    Vec3 background(Vec3 direction, float footprint) const;
    /// Part of its radiance that `diffuse` and `specular` are of.
    float light_share() const { return light_share_; }
    /// Irradiance / pi about a unit normal: what a white Lambertian surface reflects.
    Vec3 diffuse(Vec3 normal) const;
    /// Radiance averaged over the GGX lobe of this perceptual roughness about a unit mirror direction.
    Vec3 specular(Vec3 direction, float roughness) const;

private:
    Environment() = default;

    std::optional<Vec3> uniform_; ///< where it is set there are no maps
    float light_share_ = 1; ///< factor of the maps in `diffuse` and `specular`
    std::vector<FloatImage> background_levels_; ///< box-filtered, halving
    std::vector<OctahedralMap> specular_levels_; ///< GGX-filtered for equally spaced roughness
    OctahedralMap diffuse_;
};

} // namespace framelet
