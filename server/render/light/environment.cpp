#include "server/render/light/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "common/error.h"
#include "common/files/image_io.h"
#include "server/render/light/environment_filter.h"

namespace framelet {
namespace {

/// Sides in texels of the specular maps for roughness 0, 1/6, .. 1; rougher lobes need fewer texels.
constexpr int specular_sides[] = {256, 128, 64, 48, 32, 32, 32};
constexpr int roughness_levels = std::size(specular_sides);

/// Largest width in texels of the map that filtering starts from: it need not be larger.
constexpr int largest_filter_width = 1024;

OctahedralMap mirror_level(std::vector<FloatImage> const& levels, int side) {
    FloatImage const& map = level_of_width(levels, 2 * side);
    std::vector<Vec3> values;
    for (Vec3 const& direction : octahedral_directions(side)) {
        values.push_back(sample_equirect(map, equirect_from_direction(direction)));
    }
    return {side, values};
}

/// A clear day: blue deepens towards the zenith, haze at the horizon, grey ground below it.
Vec3 clear_sky(Vec3 const& direction) {
    Vec3 const zenith(0.16f, 0.33f, 0.72f);
    Vec3 const horizon(0.66f, 0.77f, 0.90f);
    Vec3 const ground_near(0.36f, 0.35f, 0.33f);
    Vec3 const ground_far(0.55f, 0.57f, 0.58f);
    float const up = direction.y;
    Vec3 const sky = glm::mix(horizon, zenith, std::pow(std::clamp(up, 0.0f, 1.0f), 0.45f));
    Vec3 const ground = glm::mix(ground_far, ground_near, std::clamp(-6 * up, 0.0f, 1.0f));
    return glm::mix(ground, sky, std::clamp(up / 0.02f + 0.5f, 0.0f, 1.0f)); // a horizon about a degree wide
}

/// The map with all values finite and >= 0. A sun in one primary colour alone, exactly 0 in the others, is what a
/// capture leaves that clipped each channel by itself; it would dye the whole scene, so it counts as white.
FloatImage cleaned(FloatImage map) {
    double sum = 0;
    for (Vec3& texel : map.rgb) {
        for (int c = 0; c < 3; ++c) {
            texel[c] = texel[c] > 0 ? std::min(texel[c], 65504.0f) : 0.0f;
        }
        sum += std::max({texel.r, texel.g, texel.b});
    }
    float const sun = static_cast<float>(100 * sum / static_cast<double>(map.rgb.size()));
    for (Vec3& texel : map.rgb) {
        float const brightest = std::max({texel.r, texel.g, texel.b});
        if (brightest > sun && texel.r + texel.g + texel.b == brightest) {
            texel = Vec3(brightest);
        }
    }
    return map;
}

} // namespace

Environment::Environment(FloatImage const& radiance) {
    FRAMELET_CHECK(radiance.width > 0 && radiance.height > 0);
    FloatImage const clean = cleaned(radiance);
    background_levels_ = equirect_levels(clean);
    std::size_t first = 0;
    while (first + 1 < background_levels_.size() && background_levels_[first].width > largest_filter_width) {
        ++first;
    }
    std::vector<FloatImage> const levels(background_levels_.begin() + static_cast<std::ptrdiff_t>(first),
                                         background_levels_.end());
    specular_levels_.push_back(mirror_level(levels, specular_sides[0]));
    for (int i = 1; i < roughness_levels; ++i) {
        specular_levels_.push_back(
            filter_specular(levels, static_cast<float>(i) / (roughness_levels - 1), specular_sides[i]));
    }
    diffuse_ = filter_diffuse(levels, 32);
}

Environment Environment::default_sky(float brightness, float light_share) {
    FloatImage sky(512, 256);
    for (int y = 0; y < sky.height; ++y) {
        for (int x = 0; x < sky.width; ++x) {
            sky.at(x, y) = brightness * clear_sky(direction_of_texel(sky, x, y));
        }
    }
    Environment environment(sky);
    environment.light_share_ = light_share;
    return environment;
}

Environment Environment::uniform(Vec3 radiance) {
    Environment out;
    out.uniform_ = glm::max(radiance, Vec3(0));
    return out;
}

Environment Environment::load(std::filesystem::path const& file) {
    return Environment(read_float_image(file));
}

Vec3 Environment::background(Vec3 direction, float footprint) const {
    if (uniform_) {
        return *uniform_;
    }
    FloatImage const& base = background_levels_[0];
    float const texel = 2 * std::numbers::pi_v<float> / static_cast<float>(base.width);
    float const top = static_cast<float>(background_levels_.size() - 1);
    float const level = footprint > texel ? std::min(std::log2(footprint / texel), top) : 0.0f;
    std::size_t const fine = static_cast<std::size_t>(level);
    float const blend = level - static_cast<float>(fine);
    Vec2 const point = equirect_from_direction(direction);
    Vec3 const value = sample_equirect(background_levels_[fine], point);
    return blend > 0 ? glm::mix(value, sample_equirect(background_levels_[fine + 1], point), blend) : value;
}

Vec3 Environment::diffuse(Vec3 normal) const {
    return uniform_ ? *uniform_ : light_share_ * diffuse_.sample(normal);
}

Vec3 Environment::specular(Vec3 direction, float roughness) const {
    if (uniform_) {
        return *uniform_;
    }
    float const level = std::clamp(roughness, 0.0f, 1.0f) * (roughness_levels - 1);
    std::size_t const sharp = std::min(static_cast<std::size_t>(level), std::size_t(roughness_levels - 2));
    Vec2 const point = octahedral_from_direction(direction);
    float const blend = level - static_cast<float>(sharp);
    if (blend >= 1) { // fully rough, as many surfaces are
        return light_share_ * specular_levels_.back().sample_at(point);
    }
    return light_share_ *
           glm::mix(specular_levels_[sharp].sample_at(point), specular_levels_[sharp + 1].sample_at(point), blend);
}

} // namespace framelet
