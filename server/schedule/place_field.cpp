#include "server/schedule/place_field.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "server/schedule/view_motion.h"

namespace framelet {
namespace {

/// Drift of one pixel of displacement: detail of a pixel is elsewhere after two.
constexpr float drift_per_pixel = 0.5f;
constexpr float most_drift = 64;
constexpr float most_displacement = most_drift / drift_per_pixel;

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
    return place.level < 0
               ? bare_error
               : unresolved_error(place.model, place.level) + drift_error(place.model, place.level, place.drift + more);
}

void drift_on(PlaceField& field, ViewRays const& from, ViewRays const& to, bool moving, float seconds) {
    bool const turning = from.origin != to.origin || from.direction != to.direction ||
                         from.direction_dx != to.direction_dx || from.origin_dx != to.origin_dx;
    for (std::uint32_t const index : field.visible()) {
        Place& place = field[index];
        float pixels = 0;
        if (turning) {
            PixelRect const rect = field.rect_of(index);
            Vec2 const centre(0.5f * static_cast<float>(rect.left + rect.right),
                              0.5f * static_cast<float>(rect.top + rect.bottom));
            pixels = view_displacement(from, to, centre, place.inverse_depth, most_displacement);
        }
        float const expected = place.speed * seconds; // pixels that the learnt motion is about
        float own = moving || turning ? place.model.motion * seconds : 0;
        if (pixels < expected) {
            own *= pixels / expected;
        }
        float const more = own + drift_per_pixel * std::max(pixels - expected, 0.0f);
        place.drift = std::min(place.drift + more, most_drift);
        if (seconds > 0 && pixels != expected) { // from now on that is what the motion is about
            place.speed = pixels / seconds;
            place.model.motion = more / seconds;
        }
    }
}

void invalidate(PlaceField& field) {
    for (std::uint32_t const index : field.visible()) {
        field[index].drift = most_drift;
    }
}

namespace {

/// Where sample `i` of a tile lies, pixels.
Vec2 sample_place(ImagePlane const& plane, Tile tile, std::size_t i) {
    PixelRect const rect = plane.tile_rect(tile);
    float const spacing = plane.sample_spacing(tile);
    auto const sample = static_cast<std::uint32_t>(i);
    return Vec2(rect.left, rect.top) + (Vec2(morton_x(sample), morton_y(sample)) + 0.5f) * spacing;
}

/// Spreads over [0, count).
std::size_t scattered(std::uint32_t seed, std::size_t count) {
    return (seed * 0x9e3779b9u >> 16) % count;
}

/// Of samples [first, last) the one that differs most from the next: where an edge is, the smallest motion shows.
std::size_t steepest(LumaHistory::Entry const& entry, std::size_t first, std::size_t last) {
    std::size_t found = first;
    float most = -1;
    for (std::size_t i = first; i < last; ++i) {
        float const step = std::abs(entry.luma[i] - entry.luma[(i + 1) % framelet_samples]);
        if (step > most) {
            most = step;
            found = i;
        }
    }
    return found;
}

/// Notes some samples of a part of a framelet, one in each of equal shares of it: in turn the steepest and any one.
void note_probes(Place& place, ImagePlane const& plane, LumaHistory::Entry const& entry, std::size_t first,
                 std::size_t count, std::size_t wanted) {
    Viewport const viewport = plane.viewport();
    if (wanted == 0) {
        return;
    }
    std::size_t const share = std::max<std::size_t>(count / wanted, 1);
    for (std::size_t i = 0; i < std::min(wanted, count) && place.probe_count < probes_per_place; ++i) {
        std::size_t const begin = first + i * share;
        std::size_t const sample = place.probe_count % 2 == 0
                                       ? steepest(entry, begin, begin + share)
                                       : begin + scattered(entry.tile.code + static_cast<std::uint32_t>(i), share);
        Vec2 const at = sample_place(plane, entry.tile, sample);
        if (at.x < static_cast<float>(viewport.width) && at.y < static_cast<float>(viewport.height)) {
            place.probes[place.probe_count++] = {at, plane.sample_spacing(entry.tile), entry.luma[sample]};
        }
    }
}

float mean_inverse_depth(Framelet const& framelet, std::size_t first, std::size_t count) {
    float sum = 0;
    for (std::size_t i = first; i < first + count; ++i) {
        sum += 1 / std::max(framelet.depth[i], 1e-6f); // infinity gives 0
    }
    return sum / static_cast<float>(count);
}

/// What the viewer holds from now on, unless it held better that is still true.
void hold(Place& place, int level, double now) {
    place.level = level;
    place.rendered = now;
    place.drift = 0;
}

bool is_change(Observation const& seen) {
    constexpr float noise = 1e-6f; // a quarter of a display step, squared
    float change = seen.mean_change;
    for (float const octave : seen.change) {
        change += octave;
    }
    return seen.has_change && change > noise;
}

} // namespace

void learn_patch(PlaceField& field, Patch const& patch, std::span<DisplayFramelet const> framelets,
                 std::span<Framelet const> rendered, double now, LumaHistory& history, std::span<std::uint8_t> send) {
    FRAMELET_CHECK(framelets.size() == rendered.size() && framelets.size() == send.size() && !framelets.empty());
    int const level = field.level_of(patch.depth);
    PlaceField::Range const range = field.range_of(patch.node);
    std::size_t const count = framelet_samples / (range.last - range.first);
    std::array<float, framelet_samples> luma;
    std::array<float, framelet_samples> change;
    std::vector<Observation> sums(range.last - range.first);
    std::vector<std::uint8_t> same(framelets.size());
    for (std::uint32_t i = range.first; i < range.last; ++i) {
        field[i].probe_count = 0;
    }
    for (std::size_t f = 0; f < framelets.size(); ++f) {
        LumaHistory::Entry const entry = make_entry(framelets[f], now);
        luma = entry.luma;
        haar_forward(luma);
        std::optional<std::span<float const, framelet_samples>> difference;
        float seconds = 0;
        LumaHistory::Entry const* const before = history.find(entry.tile);
        if (before != nullptr) {
            for (std::size_t i = 0; i < change.size(); ++i) {
                change[i] = entry.luma[i] - before->luma[i];
            }
            haar_forward(change);
            difference = std::span<float const, framelet_samples>(change);
            seconds = static_cast<float>(now - before->time);
            same[f] = before->content == entry.content;
        }
        for (std::uint32_t i = range.first; i < range.last; ++i) {
            std::size_t const first = (i - range.first) * count;
            accumulate(sums[i - range.first], observe(level, luma, difference, seconds, first, count));
            std::size_t const wanted =
                (f + 1) * probes_per_place / framelets.size() - f * probes_per_place / framelets.size();
            note_probes(field[i], field.plane(), entry, first, count, wanted);
            field[i].inverse_depth = mean_inverse_depth(rendered[f], first, count);
        }
        history.store(entry);
    }
    bool const all_same = std::all_of(same.begin(), same.end(), [](std::uint8_t s) { return s != 0; });
    // The viewer has it, or better, and that has not been seen to change: nothing to send.
    bool known = all_same;
    for (std::uint32_t i = range.first; i < range.last; ++i) {
        Place const& place = field[i];
        known = known && (field.pixels_of(i) == 0 || (place.level >= level && place.changed <= place.rendered));
    }
    for (std::uint32_t i = range.first; i < range.last; ++i) {
        Place& place = field[i];
        Observation const seen = mean_of(sums[i - range.first], static_cast<int>(framelets.size()));
        learn(place.model, seen);
        if (seen.has_change) {
            place.settled = !is_change(seen);
        }
        if (is_change(seen) || place.rendered == never) {
            place.changed = now;
        }
        place.checked = now;
        if (level >= pixel_level) {
            place.inspected = now;
        }
        if (!known) {
            hold(place, level, now);
        } else {
            place.drift = 0;
            if (place.level == level) { // what is held is the very picture of now
                place.rendered = now;
            }
        }
    }
    std::fill(send.begin(), send.end(), known ? 0 : 1);
}

void learn_probes(Place& place, std::span<float const> luma, double now) {
    FRAMELET_CHECK(luma.size() == place.probe_count && place.level >= 0);
    constexpr float step = 1.0f / 255;
    // The steepest samples say whether there is a change; how large it is on the whole the others know.
    constexpr float steep_weight = 1.0f / 16;
    float sum = 0;
    float weights = 0;
    for (std::size_t i = 0; i < luma.size(); ++i) {
        float const difference = std::abs(luma[i] - place.probes[i].luma);
        float const weight = i % 2 == 0 ? steep_weight : 1 - steep_weight;
        sum += difference > 0.5f * step ? weight * difference * difference : 0;
        weights += weight;
    }
    float const error = luma.empty() ? 0 : sum / weights;
    if (error > 0) {
        float const drift = drift_of_error(place.model, place.level, error);
        place.drift = std::max(place.drift, drift);
        auto const seconds = static_cast<float>(now - place.checked);
        place.model.motion = std::max(place.model.motion, seconds > 0 ? drift / seconds : 0);
        place.changed = now;
        place.settled = false;
    } else {
        // Too few samples to say so of all of it, unless its last rendering did.
        constexpr float least_motion = 0.5f;
        float const kept = place.settled || place.model.motion < least_motion ? 0 : 0.5f;
        place.drift *= kept;
        place.model.motion *= kept;
    }
    place.checked = now;
}

} // namespace framelet
