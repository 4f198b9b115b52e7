#include "server/sampling/field/region_field.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "server/render/rays_per_sample.h"
#include "server/sampling/field/view_motion.h"

namespace framelet {
namespace {

/// Drift of one pixel of displacement: detail of a pixel is elsewhere after two.
constexpr float drift_per_pixel = 0.5f;
constexpr float most_drift = 64;
constexpr float most_displacement = most_drift / drift_per_pixel;

Vec2 centre_of(PixelRect const& rect) {
    return 0.5f * Vec2(static_cast<float>(rect.left + rect.right), static_cast<float>(rect.top + rect.bottom));
}

/// Notes at every region how far what comes there has come: a far background does not move, but what is before it may
/// move over it.
void find_arrivals(RegionField& field, ViewRays const& from, ViewRays const& to) {
    for (std::uint32_t const index : field.visible()) {
        field[index].arriving = 0;
    }
    Viewport const viewport = field.plane().viewport();
    auto const side = static_cast<float>(field.region_side());
    int const columns = (viewport.width - 1) / field.region_side();
    int const rows = (viewport.height - 1) / field.region_side();
    for (std::uint32_t const index : field.visible()) {
        PixelRect const rect = field.rect_of(index);
        float const inverse_depth = field[index].inverse_depth;
        float const pixels = view_displacement(from, to, centre_of(rect), inverse_depth, most_displacement);
        if (pixels < 1) {
            continue;
        }
        Vec2 low(INFINITY), high(-INFINITY);
        for (int const x : {rect.left, rect.right}) {
            for (int const y : {rect.top, rect.bottom}) {
                if (auto const there = moved_pixel(from, to, Vec2(x, y), inverse_depth)) {
                    low = glm::min(low, *there);
                    high = glm::max(high, *there);
                }
            }
        }
        auto const place = [side](float pixel, int last) {
            return static_cast<int>(std::clamp(std::floor(pixel / side), 0.0f, static_cast<float>(last)));
        };
        if (!(high.x > 0 && high.y > 0 && low.x < static_cast<float>(viewport.width) &&
              low.y < static_cast<float>(viewport.height))) {
            continue;
        }
        for (int row = place(low.y, rows); row <= place(high.y, rows); ++row) {
            for (int column = place(low.x, columns); column <= place(high.x, columns); ++column) {
                Region& region =
                    field[morton_index(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row))];
                region.arriving = std::max(region.arriving, pixels);
            }
        }
    }
}

/// Level that a patch shows with so many rays a sample: means of four are as good as samples of the next finer level.
int shown_level(RegionField const& field, Patch const& patch, int rays_per_sample) {
    return std::min(field.level_of(patch.depth) + (rays_per_sample == single_ray ? 0 : 1), sampling_levels - 1);
}

} // namespace

RegionField::RegionField(ImagePlane plane) : plane_(plane), depth_(field_depth(plane)) {
    regions_.resize(std::size_t{1} << (2 * depth_));
    pixels_.resize(regions_.size());
    Viewport const viewport = plane_.viewport();
    for (std::uint32_t i = 0; i < regions_.size(); ++i) {
        PixelRect const rect = rect_of(i);
        int const width = std::min(rect.right, viewport.width) - rect.left;
        int const height = std::min(rect.bottom, viewport.height) - rect.top;
        if (width > 0 && height > 0) {
            visible_.push_back(i);
            pixels_[i] = static_cast<float>(width) * static_cast<float>(height);
        }
    }
}

PixelRect RegionField::rect_of(std::uint32_t index) const {
    return plane_.tile_rect({(1u << (2 * depth_)) + index});
}

RegionField::Range RegionField::range_of(Tile node) const {
    int const shift = 2 * (depth_ - node.depth());
    FRAMELET_CHECK(shift >= 0);
    return {node.index() << shift, (node.index() + 1) << shift};
}

float shown_error(Region const& region, float more) {
    bool const taken = region.taken.level >= 0;
    int const level = taken ? region.taken.level : region.level;
    float const drift = (taken ? region.taken.drift : region.drift) + more;
    return level < 0 ? bare_error : unresolved_error(region.model, level) + drift_error(region.model, level, drift);
}

void drift_on(RegionField& field, ViewRays const& from, ViewRays const& to, bool moving, float seconds) {
    bool const turning = from.origin != to.origin || from.direction != to.direction ||
                         from.direction_dx != to.direction_dx || from.origin_dx != to.origin_dx;
    if (turning) {
        find_arrivals(field, from, to);
    }
    for (std::uint32_t const index : field.visible()) {
        Region& region = field[index];
        float pixels = 0;
        if (turning) {
            Vec2 const centre = centre_of(field.rect_of(index));
            pixels =
                std::max(view_displacement(from, to, centre, region.inverse_depth, most_displacement), region.arriving);
        }
        float const expected = region.speed * seconds; // pixels of camera motion that the learnt motion stands for
        float own = moving || turning ? region.model.motion * seconds : 0;
        if (pixels < expected) {
            own *= pixels / expected;
        }
        float const more = own + drift_per_pixel * std::max(pixels - expected, 0.0f);
        region.drift = std::min(region.drift + more, most_drift);
        region.taken.drift = std::min(region.taken.drift + more, most_drift);
        if (seconds > 0 && pixels != expected) { // from now on the learnt motion stands for this
            region.speed = pixels / seconds;
            region.model.motion = more / seconds;
        }
    }
}

void take(RegionField& field, Patch const& patch, double now, int rays_per_sample) {
    RegionField::Range const range = field.range_of(patch.node);
    for (std::uint32_t i = range.first; i < range.last; ++i) {
        field[i].taken = {shown_level(field, patch, rays_per_sample), 0, now};
        field[i].asked = now;
    }
}

void release(RegionField& field, std::span<Patch const> patches, double when) {
    for (Patch const& patch : patches) {
        RegionField::Range const range = field.range_of(patch.node);
        for (std::uint32_t i = range.first; i < range.last; ++i) {
            if (field[i].taken.when == when) {
                field[i].taken = {};
            }
        }
    }
}

void invalidate(RegionField& field) {
    for (std::uint32_t const index : field.visible()) {
        field[index].drift = field[index].taken.drift = most_drift;
    }
}

} // namespace framelet
