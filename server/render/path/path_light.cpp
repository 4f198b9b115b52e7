#include "server/render/path/path_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/color.h"
#include "common/error.h"
#include "common/morton.h"
#include "server/render/flush_denormals.h"
#include "server/render/light/luminance.h"
#include "server/render/path/path_random.h"
#include "server/render/path/path_tracing.h"
#include "server/render/view_packet.h"

namespace framelet {
namespace {

/// Fewer paths of a sample say little of how much they differ.
constexpr int telling_paths = 16;
/// Pixels that a path covers in textures, as a share of the spacing of samples: many are averaged.
constexpr float path_footprint = 0.25f;

/// Luminance as a viewer sees it, without rounding, [0, 1].
float shown_luminance(Vec3 const& radiance, DisplayTransform const& transform) {
    return srgb_from_linear(luminance(transform.shown(radiance)));
}

} // namespace

LampSizes lamp_sizes(LightOptions const& light, Bounds const& bounds) {
    constexpr float usual_metres = 0.1f, most_share = 0.01f;
    float const size = bounds.empty() ? 0.0f : glm::length(bounds.size());
    LampSizes sizes;
    sizes.sun = 0.5f * light.sun_degrees * std::numbers::pi_v<float> / 180;
    sizes.lamp = 0.5f * light.lamp_metres.value_or(std::min(usual_metres, most_share * size));
    return sizes;
}

PathLight::PathLight(PreparedScene const& scene, PathOptions const& options)
    : scene_(std::make_unique<PathScene>(scene)), options_(options) {}

PathLight::~PathLight() = default;

void PathLight::update() {
    scene_->update();
}

void PathSums::hold(ImagePlane const& plane) {
    if (empty() || plane.viewport() != plane_.viewport()) {
        clear();
        plane_ = plane;
        columns_ = (plane.viewport().width + framelet_side - 1) / framelet_side;
        int const rows = (plane.viewport().height + framelet_side - 1) / framelet_side;
        tiles_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows));
    }
}

TileSums& PathSums::operator[](Tile tile) {
    FRAMELET_CHECK(tile.depth() == plane_.pixel_depth());
    PixelRect const rect = plane_.tile_rect(tile);
    int const column = rect.left / framelet_side, row = rect.top / framelet_side;
    return tiles_.at(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(column));
}

void trace_tile(PathLight const& light, ViewRays const& view, ImagePlane const& plane, Tile tile, int path,
                TileLight& out) {
    FlushDenormals const flush;
    PixelRect const rect = plane.tile_rect(tile);
    float const spacing = plane.sample_spacing(tile);
    // In samples of the tile's level, so that with one a pixel these are the numbers of `render_paths`.
    auto const left = static_cast<std::uint32_t>(static_cast<float>(rect.left) / spacing);
    auto const top = static_cast<std::uint32_t>(static_cast<float>(rect.top) / spacing);
    Footprint footprint;
    footprint.width.fill(glm::length(view.origin_dx) * spacing * path_footprint);
    footprint.slope.fill(glm::length(view.direction_dx) * spacing * path_footprint);
    PathNumbers numbers;
    LaneVec3 radiance;
    for (int first = 0; first < framelet_samples; first += lanes) {
        auto const position = [&](int i) {
            auto const sample = static_cast<std::uint32_t>(first + i);
            std::uint32_t const x = left + morton_x(sample), y = top + morton_y(sample);
            numbers.pixel_seed[i] = hashed(hashed(light.options().seed, y), x);
            numbers.sample[i] = static_cast<std::uint32_t>(path);
            return (Vec2(x, y) + random_pair(numbers.pixel_seed[i], numbers.sample[i], 0)) * spacing;
        };
        RayPacket rays = rays_through(view, position);
        trace_paths(light.scene(), light.options(), rays, all_lanes, footprint, numbers, radiance);
        for (int i = 0; i < lanes; ++i) {
            Vec3 const brought = radiance.get(i);
            auto const sample = static_cast<std::size_t>(first) + static_cast<std::size_t>(i);
            out.red[sample] = brought.r;
            out.green[sample] = brought.g;
            out.blue[sample] = brought.b;
        }
    }
}

int first_to_add(TileSums& sums, int paths) {
    if (sums.paths >= paths) {
        sums = {};
    }
    return sums.paths;
}

void add_path(TileLight const& light, TileSums& sums) {
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        sums.red[i] += light.red[i];
        sums.green[i] += light.green[i];
        sums.blue[i] += light.blue[i];
        float const shade = luminance(Vec3(light.red[i], light.green[i], light.blue[i]));
        sums.squares[i] += shade * shade;
    }
    ++sums.paths;
}

void set_means(TileSums const& sums, Framelet& out) {
    float const share = 1 / static_cast<float>(sums.paths);
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        out.red[i] = sums.red[i] * share;
        out.green[i] = sums.green[i] * share;
        out.blue[i] = sums.blue[i] * share;
    }
}

float squared_error(TileSums const& sums, DisplayTransform const& transform) {
    if (sums.paths < telling_paths) {
        return INFINITY;
    }
    auto const count = static_cast<float>(sums.paths);
    float sum = 0;
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        Vec3 const mean = Vec3(sums.red[i], sums.green[i], sums.blue[i]) / count;
        float const shade = luminance(mean);
        float const variance = std::max(sums.squares[i] / count - shade * shade, 0.0f) / (count - 1);
        if (variance > 0 && shade > 0) {
            float const share = std::sqrt(variance) / shade; // of the radiance, which is never below 0
            float const above = shown_luminance(mean * (1 + share), transform);
            float const below = shown_luminance(mean * std::max(1 - share, 0.0f), transform);
            sum += 0.25f * (above - below) * (above - below);
        }
    }
    return sum / static_cast<float>(framelet_samples);
}

} // namespace framelet
