#include "server/sampling/field/region_learning.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace framelet {
namespace {

/// Position of sample `i` of a tile, pixels.
Vec2 sample_position(ImagePlane const& plane, Tile tile, std::size_t i) {
    PixelRect const rect = plane.tile_rect(tile);
    float const spacing = plane.sample_spacing(tile);
    auto const sample = static_cast<std::uint32_t>(i);
    return Vec2(rect.left, rect.top) + (Vec2(morton_x(sample), morton_y(sample)) + 0.5f) * spacing;
}

/// Spreads seeds over [0, count).
std::size_t scattered(std::uint32_t seed, std::size_t count) {
    return (seed * 0x9e3779b9u >> 16) % count;
}

float luma_at(LumaHistory::Entry const& entry, std::size_t sample) {
    return static_cast<float>(entry.luma[sample]) / LumaHistory::luma_steps;
}

using Steps = std::array<std::uint16_t, framelet_samples>;

/// Difference of each sample to the next one along the curve, in steps of luma: at an edge the smallest motion shows.
Steps steps_of(LumaHistory::Entry const& entry) {
    auto const step = [](int a, int b) { return static_cast<std::uint16_t>(std::abs(a - b)); };
    Steps steps;
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
        steps[i] = step(entry.luma[i], entry.luma[i + 1]);
    }
    steps.back() = step(entry.luma.back(), entry.luma.front());
    return steps;
}

/// Index of the steepest of samples [first, last).
std::size_t steepest(Steps const& steps, std::size_t first, std::size_t last) {
    std::uint16_t most = 0;
    for (std::size_t i = first; i < last; ++i) {
        most = std::max(most, steps[i]);
    }
    while (first + 1 < last && steps[first] < most) {
        ++first;
    }
    return first;
}

/// Notes some samples of a part of a framelet as probes, one in each of equal shares of it: in turn the steepest and
/// any one.
void note_probes(RegionFindings& region, ImagePlane const& plane, LumaHistory::Entry const& entry, Steps const& steps,
                 std::size_t first, std::size_t count, std::size_t wanted) {
    Viewport const viewport = plane.viewport();
    if (wanted == 0) {
        return;
    }
    std::size_t const share = std::max<std::size_t>(count / wanted, 1);
    for (std::size_t i = 0; i < std::min(wanted, count) && region.probe_count < probes_per_region; ++i) {
        std::size_t const begin = first + i * share;
        std::size_t const sample = region.probe_count % 2 == 0
                                       ? steepest(steps, begin, begin + share)
                                       : begin + scattered(entry.tile.code + static_cast<std::uint32_t>(i), share);
        Vec2 const at = sample_position(plane, entry.tile, sample);
        if (at.x < static_cast<float>(viewport.width) && at.y < static_cast<float>(viewport.height)) {
            region.probes[region.probe_count++] = {at, plane.sample_spacing(entry.tile), luma_at(entry, sample)};
        }
    }
}

float mean_inverse_depth(Framelet const& framelet, std::size_t first, std::size_t count) {
    // Four sums side by side, which do not wait for each other. A part of a single sample uses one of them.
    std::array<float, 4> sums{};
    for (std::size_t i = 0; i < count; ++i) {
        sums[i % sums.size()] += 1 / std::max(framelet.depth[first + i], 1e-6f); // infinity gives 0
    }
    return ((sums[0] + sums[1]) + (sums[2] + sums[3])) / static_cast<float>(count);
}

/// Mean squared difference of the probes' luma to what it was, 0 below half a step of the display. The steepest samples
/// say whether there is one; how large it is on the whole the others know.
template <class Before>
float probed_error(std::span<float const> luma, Before&& before) {
    constexpr float step = 1.0f / 255;
    constexpr float steep_weight = 1.0f / 16;
    float sum = 0;
    float weights = 0;
    for (std::size_t i = 0; i < luma.size(); ++i) {
        float const difference = std::abs(luma[i] - before(i));
        float const weight = i % 2 == 0 ? steep_weight : 1 - steep_weight;
        sum += difference > 0.5f * step ? weight * difference * difference : 0;
        weights += weight;
    }
    return luma.empty() ? 0 : sum / weights;
}

bool shows_motion(Framelet const& framelet) {
    return std::ranges::any_of(framelet.body, [](BodyNumber body) { return body != static_body; }) ||
           std::ranges::any_of(framelet.drift, [](Drift const& drift) { return drift.any(); });
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

float drift_since(Region const& region, double now) {
    if (region.taken.level < 0) {
        return 0;
    }
    // Where the region was taken again meanwhile, its drift since `now` is no longer known: `drift` is an upper bound.
    return region.taken.when == now ? region.taken.drift : region.drift;
}

double examine_patch(RegionField const& field, Patch const& patch, std::span<DisplayFramelet const> framelets,
                     std::span<Framelet const> rendered, RenderedTimes times, RenderedMoment const& moment,
                     LumaHistory const& history, std::span<LumaHistory::Entry> entries,
                     std::span<RegionFindings> regions) {
    FRAMELET_CHECK(framelets.size() == rendered.size() && framelets.size() == entries.size() && !framelets.empty());
    FRAMELET_CHECK(framelet_samples % regions.size() == 0);
    int const level = field.level_of(patch.depth);
    std::size_t const count = framelet_samples / regions.size();
    std::array<float, framelet_samples> luma;
    std::array<float, framelet_samples> change;
    std::fill(regions.begin(), regions.end(), RegionFindings{});
    double same_since = times.now;
    for (std::size_t f = 0; f < framelets.size(); ++f) {
        LumaHistory::Entry& entry = entries[f];
        fill_entry(entry, framelets[f], times.now, times.moment);
        entry.moves = moment.motions != nullptr && shows_motion(rendered[f]);
        for (std::size_t i = 0; i < luma.size(); ++i) {
            luma[i] = luma_at(entry, i);
        }
        haar_forward(luma);
        std::optional<std::span<float const, framelet_samples>> difference;
        float seconds = 0;
        LumaHistory::Entry const* const before = history.find(entry.tile);
        // Two renderings of one moment are the same, which says nothing of what time changes.
        if (before != nullptr && before->moment != entry.moment) {
            for (std::size_t i = 0; i < change.size(); ++i) {
                change[i] = static_cast<float>(entry.luma[i] - before->luma[i]) / LumaHistory::luma_steps;
            }
            haar_forward(change);
            difference = std::span<float const, framelet_samples>(change);
            seconds = static_cast<float>(entry.moment - before->moment);
        }
        bool const in_place = before != nullptr && before->time >= times.base && !before->moves && !entry.moves;
        bool const same = in_place && before->content == entry.content;
        same_since = std::min(same_since, same ? before->time : never);
        std::size_t const wanted =
            (f + 1) * probes_per_region / framelets.size() - f * probes_per_region / framelets.size();
        Steps const steps = steps_of(entry);
        std::size_t first = 0;
        for (RegionFindings& region : regions) {
            accumulate(region.seen, observe(level, luma, difference, seconds, first, count));
            note_probes(region, field.plane(), entry, steps, first, count, wanted);
            region.inverse_depth += mean_inverse_depth(rendered[f], first, count);
            region.meeting_speed =
                std::max(region.meeting_speed, meeting_speed(rendered[f], field.plane(), moment, first, count));
            first += count;
        }
    }
    for (RegionFindings& region : regions) {
        region.seen = mean_of(region.seen, static_cast<int>(framelets.size()));
        region.inverse_depth /= static_cast<float>(framelets.size());
    }
    return same_since;
}

bool learn_patch(RegionField& field, Patch const& patch, std::span<RegionFindings const> regions, double same_since,
                 double still_since, double now, bool skips) {
    int const level = field.level_of(patch.depth);
    RegionField::Range const range = field.range_of(patch.node);
    FRAMELET_CHECK(regions.size() == range.last - range.first);
    // The viewer has it, or better, and either has had it since before it looked the same, or what it got later is of a
    // region that has not changed meanwhile: nothing to send.
    bool known = skips && same_since > never;
    for (std::uint32_t i = range.first; i < range.last; ++i) {
        Region const& region = field[i];
        bool const goes_on = std::min(region.rendered, std::max(region.changed, region.suspected)) <= same_since;
        known = known && (field.pixels_of(i) == 0 || (region.level >= level && goes_on));
    }
    for (std::uint32_t i = range.first; i < range.last; ++i) {
        Region& region = field[i];
        RegionFindings const& found = regions[i - range.first];
        region.probes = found.probes;
        region.probe_count = found.probe_count;
        std::ranges::transform(found.probes, region.seen.begin(), &Probe::luma);
        region.inverse_depth = found.inverse_depth;
        learn(region.model, found.seen);
        if (level == sampling_levels - 1) {
            region.left = unresolved_error(found.seen);
        }
        // What bodies uncover may look like what was rendered there before. At `meeting_speed` it fills the region in
        // the inverse of this, seconds.
        region.model.motion =
            std::max(region.model.motion, found.meeting_speed / static_cast<float>(field.region_side()));
        if (found.seen.has_change) {
            region.settled = !is_change(found.seen);
        }
        if (is_change(found.seen) || region.rendered == never) {
            region.changed = now;
        }
        if (!found.seen.has_change && region.rendered < still_since) {
            region.suspected = now;
        }
        region.checked = now;
        if (level >= pixel_level) {
            region.refreshed = now;
        }
        region.drift = drift_since(region, now);
        if (!known || region.level == level) { // where it is known, what is held is the very picture of then
            region.level = level;
            region.rendered = now;
            region.supersampled = false;
        }
    }
    return !known;
}

void learn_probes(Region& region, std::span<float const> luma, double now) {
    FRAMELET_CHECK(luma.size() == region.probe_count && region.level >= 0);
    float const error = probed_error(luma, [&](std::size_t i) { return region.probes[i].luma; });
    float const change = probed_error(luma, [&](std::size_t i) { return region.seen[i]; });
    auto const seconds = static_cast<float>(now - region.checked);
    if (error > 0) {
        region.drift = std::max(region.drift, drift_of_error(region.model, region.level, error));
        region.settled = false;
    }
    if (change > 0) {
        float const drift = drift_of_error(region.model, region.level, change);
        region.model.motion = std::max(region.model.motion, seconds > 0 ? drift / seconds : 0);
        region.changed = now;
    } else if (error > 0) {
        // The region is not what the viewer has, and stands: a step, after which it is worth rendering again.
        constexpr float unseen_drift = 0.1f;
        region.model.motion = std::min(0.5f * region.model.motion, seconds > 0 ? unseen_drift / seconds : INFINITY);
        region.model.decay = RegionModel::unknown_decay();
    } else {
        // The probes are too few to say that all of it stands, unless its last rendering said so.
        constexpr float least_motion = 0.5f;
        float const kept = region.settled || region.model.motion < least_motion ? 0 : 0.5f;
        region.drift *= kept;
        region.model.motion *= kept;
    }
    std::ranges::copy(luma, region.seen.begin());
    region.checked = now;
}

} // namespace framelet
