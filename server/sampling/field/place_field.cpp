#include "server/sampling/field/place_field.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "server/sampling/field/view_motion.h"

namespace framelet {
namespace {

constexpr float most_drift = 64;
constexpr float most_displacement = most_drift / drift_per_pixel;

Vec2 centre_of(PixelRect const& rect) {
    return 0.5f * Vec2(static_cast<float>(rect.left + rect.right), static_cast<float>(rect.top + rect.bottom));
}

/// Notes at every place how far what comes there has come: a far background does not move, but what is before it may
/// move over it.
void find_arrivals(PlaceField& field, ViewRays const& from, ViewRays const& to) {
    for (std::uint32_t const index : field.visible()) {
        field[index].arriving = 0;
    }
    Viewport const viewport = field.plane().viewport();
    auto const side = static_cast<float>(field.place_side());
    int const columns = (viewport.width - 1) / field.place_side();
    int const rows = (viewport.height - 1) / field.place_side();
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
        auto const cell = [side](float pixel, int last) {
            return static_cast<int>(std::clamp(std::floor(pixel / side), 0.0f, static_cast<float>(last)));
        };
        if (!(high.x > 0 && high.y > 0 && low.x < static_cast<float>(viewport.width) &&
              low.y < static_cast<float>(viewport.height))) {
            continue;
        }
        for (int row = cell(low.y, rows); row <= cell(high.y, rows); ++row) {
            for (int column = cell(low.x, columns); column <= cell(high.x, columns); ++column) {
                Place& place = field[morton_index(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row))];
                place.arriving = std::max(place.arriving, pixels);
            }
        }
    }
}

} // namespace

PlaceField::PlaceField(ImagePlane plane) : plane_(plane), depth_(field_depth(plane)) {
    places_.resize(std::size_t{1} << (2 * depth_));
    pixels_.resize(places_.size());
    Viewport const viewport = plane_.viewport();
    for (std::uint32_t i = 0; i < places_.size(); ++i) {
        PixelRect const rect = rect_of(i);
        int const width = std::min(rect.right, viewport.width) - rect.left;
        int const height = std::min(rect.bottom, viewport.height) - rect.top;
        if (width > 0 && height > 0) {
            visible_.push_back(i);
            pixels_[i] = static_cast<float>(width) * static_cast<float>(height);
        }
    }
}

PixelRect PlaceField::rect_of(std::uint32_t index) const {
    return plane_.tile_rect({(1u << (2 * depth_)) + index});
}

PlaceField::Range PlaceField::range_of(Tile node) const {
    int const shift = 2 * (depth_ - node.depth());
    FRAMELET_CHECK(shift >= 0);
    return {node.index() << shift, (node.index() + 1) << shift};
}

float shown_error(Place const& place, float more) {
    bool const taken = place.taken.level >= 0;
    int const level = taken ? place.taken.level : place.level;
    float const drift = (taken ? place.taken.drift : place.drift) + more;
    return level < 0 ? bare_error : unresolved_error(place.model, level) + drift_error(place.model, level, drift);
}

void drift_on(PlaceField& field, ViewRays const& from, ViewRays const& to, bool moving, float seconds) {
    bool const turning = from.origin != to.origin || from.direction != to.direction ||
                         from.direction_dx != to.direction_dx || from.origin_dx != to.origin_dx;
    if (turning) {
        find_arrivals(field, from, to);
    }
    for (std::uint32_t const index : field.visible()) {
        Place& place = field[index];
        float pixels = 0;
        if (turning) {
            Vec2 const centre = centre_of(field.rect_of(index));
            pixels =
                std::max(view_displacement(from, to, centre, place.inverse_depth, most_displacement), place.arriving);
        }
        float const expected = place.speed * seconds; // pixels that the learnt motion is about
        float own = moving || turning ? place.model.motion * seconds : 0;
        if (pixels < expected) {
            own *= pixels / expected;
        }
        float const more = own + drift_per_pixel * std::max(pixels - expected, 0.0f);
        place.drift = std::min(place.drift + more, most_drift);
        place.taken.drift = std::min(place.taken.drift + more, most_drift);
        if (seconds > 0 && pixels != expected) { // from now on that is what the motion is about
            place.speed = pixels / seconds;
            place.model.motion = more / seconds;
        }
    }
}

int shown_level(PlaceField const& field, Patch const& patch, int rays_per_sample) {
    return std::min(field.level_of(patch.depth) + (rays_per_sample == single_ray ? 0 : 1), sampling_levels - 1);
}

void take(PlaceField& field, Patch const& patch, double now, int rays_per_sample) {
    PlaceField::Range const range = field.range_of(patch.node);
    for (std::uint32_t i = range.first; i < range.last; ++i) {
        field[i].taken = {shown_level(field, patch, rays_per_sample), 0, now};
        field[i].asked = now;
    }
}

void release(PlaceField& field, std::span<Patch const> patches, double when) {
    for (Patch const& patch : patches) {
        PlaceField::Range const range = field.range_of(patch.node);
        for (std::uint32_t i = range.first; i < range.last; ++i) {
            if (field[i].taken.when == when) {
                field[i].taken = {};
            }
        }
    }
}

void invalidate(PlaceField& field) {
    for (std::uint32_t const index : field.visible()) {
        field[index].drift = field[index].taken.drift = most_drift;
    }
}

} // namespace framelet
