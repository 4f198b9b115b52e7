#include "server/render/light/environment_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "server/render/light/sphere_sampling.h"

namespace framelet {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Rows of an equirectangular map cover less of the sphere towards the poles.
float row_weight(int y, int height) {
    return std::sin(pi * (static_cast<float>(y) + 0.5f) / static_cast<float>(height));
}

FloatImage halved(FloatImage const& from) {
    FloatImage out(std::max(1, from.width / 2), std::max(1, from.height / 2));
    tbb::parallel_for(0, out.height, [&](int y) {
        int const y0 = static_cast<int>(std::int64_t(y) * from.height / out.height);
        int const y1 = std::max(y0 + 1, static_cast<int>(std::int64_t(y + 1) * from.height / out.height));
        for (int x = 0; x < out.width; ++x) {
            int const x0 = static_cast<int>(std::int64_t(x) * from.width / out.width);
            int const x1 = std::max(x0 + 1, static_cast<int>(std::int64_t(x + 1) * from.width / out.width));
            Vec3 sum(0);
            float weight = 0;
            for (int j = y0; j < y1; ++j) {
                float const w = row_weight(j, from.height);
                for (int i = x0; i < x1; ++i) {
                    sum += from.at(i, j) * w;
                    weight += w;
                }
            }
            out.at(x, y) = sum / weight;
        }
    });
    return out;
}

/// One direction of a lobe about +Z.
struct LobeSample {
    Vec3 direction; ///< unit
    float weight; ///< those of a lobe sum to 1
    float solid_angle; ///< steradians that it stands for; a wider one reads a coarser level
};

std::vector<LobeSample> ggx_lobe(float roughness, int count) {
    float const alpha = roughness * roughness;
    std::vector<LobeSample> samples;
    float total = 0;
    for (int i = 0; i < count; ++i) {
        float const e1 = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
        float const phi = 2 * pi * unit_fraction(reversed_bits(static_cast<std::uint32_t>(i)));
        float const cosine = std::sqrt((1 - e1) / (1 + (alpha * alpha - 1) * e1)); // of the half vector
        float const sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
        Vec3 const half(sine * std::cos(phi), sine * std::sin(phi), cosine);
        Vec3 const out = half * (2 * cosine) - Vec3(0, 0, 1);
        if (out.z <= 0) {
            continue;
        }
        float const d = cosine * cosine * (alpha * alpha - 1) + 1;
        float const density = alpha * alpha / (pi * d * d) / 4; // D n.h / (4 v.h), and v = n here
        samples.push_back({out, out.z, 1 / (static_cast<float>(count) * density)});
        total += out.z;
    }
    for (LobeSample& sample : samples) {
        sample.weight /= total;
    }
    return samples;
}

Vec3 sample_level(std::vector<FloatImage> const& levels, float level, Vec2 point) {
    float const top = static_cast<float>(levels.size() - 1);
    float const clamped = std::clamp(level, 0.0f, top);
    std::size_t const fine = static_cast<std::size_t>(clamped);
    std::size_t const coarse = std::min(fine + 1, levels.size() - 1);
    float const blend = clamped - static_cast<float>(fine);
    return glm::mix(sample_equirect(levels[fine], point), sample_equirect(levels[coarse], point), blend);
}

} // namespace

Vec2 equirect_from_direction(Vec3 const& d) {
    float const length = std::max(glm::length(d), 1e-30f);
    float const u = 0.5f + std::atan2(d.x, -d.z) / (2 * pi);
    return {u, std::acos(std::clamp(d.y / length, -1.0f, 1.0f)) / pi};
}

Vec3 direction_from_equirect(Vec2 point) {
    float const phi = (point.x - 0.5f) * 2 * pi;
    float const theta = point.y * pi;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

Vec3 direction_of_texel(FloatImage const& map, int x, int y) {
    return direction_from_equirect(Vec2((static_cast<float>(x) + 0.5f) / static_cast<float>(map.width),
                                        (static_cast<float>(y) + 0.5f) / static_cast<float>(map.height)));
}

Vec3 sample_equirect(FloatImage const& map, Vec2 point) {
    float const x = point.x * static_cast<float>(map.width) - 0.5f;
    float const y =
        std::clamp(point.y * static_cast<float>(map.height) - 0.5f, 0.0f, static_cast<float>(map.height - 1));
    int const column = static_cast<int>(std::floor(x));
    int const row = static_cast<int>(y);
    int const left = (column % map.width + map.width) % map.width;
    int const right = (left + 1) % map.width;
    int const below = std::min(row + 1, map.height - 1);
    float const s = x - static_cast<float>(column);
    float const t = y - static_cast<float>(row);
    return glm::mix(glm::mix(map.at(left, row), map.at(right, row), s),
                    glm::mix(map.at(left, below), map.at(right, below), s), t);
}

std::vector<FloatImage> equirect_levels(FloatImage const& map) {
    std::vector<FloatImage> levels{map};
    while (levels.back().width > 8 && levels.back().height > 4) {
        levels.push_back(halved(levels.back()));
    }
    return levels;
}

FloatImage const& level_of_width(std::vector<FloatImage> const& levels, int width) {
    for (FloatImage const& level : levels) {
        if (level.width <= width) {
            return level;
        }
    }
    return levels.back();
}

OctahedralMap filter_diffuse(std::vector<FloatImage> const& levels, int side) {
    FloatImage const& map = level_of_width(levels, 128);
    struct Source {
        Vec3 direction, radiance;
        float weight;
    };
    std::vector<Source> sources;
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            sources.push_back({direction_of_texel(map, x, y), map.at(x, y), row_weight(y, map.height)});
        }
    }
    std::vector<Vec3> const normals = octahedral_directions(side);
    std::vector<Vec3> values(normals.size());
    tbb::parallel_for(std::size_t(0), normals.size(), [&](std::size_t i) {
        Vec3 sum(0);
        float total = 0;
        for (Source const& source : sources) {
            float const weight = source.weight * std::max(0.0f, glm::dot(normals[i], source.direction));
            sum += source.radiance * weight;
            total += weight;
        }
        values[i] = sum / total;
    });
    return {side, values};
}

OctahedralMap filter_specular(std::vector<FloatImage> const& levels, float roughness, int side) {
    std::vector<LobeSample> const lobe = ggx_lobe(roughness, 96);
    float const texel_angle = 4 * pi / (static_cast<float>(levels[0].width) * static_cast<float>(levels[0].height));
    std::vector<Vec3> const mirror = octahedral_directions(side);
    std::vector<Vec3> values(mirror.size());
    tbb::parallel_for(std::size_t(0), mirror.size(), [&](std::size_t i) {
        Mat3 const frame = frame_about(mirror[i]);
        Vec3 sum(0);
        for (LobeSample const& sample : lobe) {
            // A level too coarse rather than too fine: neighbours' areas overlap and hide the pattern.
            float const level = 0.5f * std::log2(sample.solid_angle / texel_angle) + 1;
            sum += sample_level(levels, level, equirect_from_direction(frame * sample.direction)) * sample.weight;
        }
        values[i] = sum;
    });
    return {side, values};
}

} // namespace framelet
