// Learns from what was rendered, in two steps: `examine_patch` finds what the framelets of a patch say of its regions
// (for all patches in parallel), `learn_patch` then brings the field up to date. In: framelets, probes. Out: the field,
// brought up to date, and whether the viewer needs what was rendered.
#pragma once

#include <span>

#include "server/sampling/field/meeting_bodies.h"
#include "server/sampling/field/region_field.h"
#include "server/sampling/model/luma_history.h"

namespace framelet {

/// Findings of a rendering for one region.
struct RegionFindings {
    Observation seen;
    std::array<Probe, probes_per_region> probes{};
    std::size_t probe_count = 0;
    float inverse_depth = 0; ///< mean, 1/metres
    float meeting_speed = 0; ///< greatest at which bodies pass each other, pixels a second
};

/// Times of a rendering, seconds, steady: `now`, when it was planned; `moment`, when what it shows was the present;
/// `base`, as `base_begun` of the plan.
struct RenderedTimes {
    double now = 0, moment = 0, base = never;
};

/// Examines one patch. `framelets`: one for each of its visible tiles; `rendered`: the same with depth. Fills `entries`
/// (one a framelet) and `regions` (one a region of the patch). Returns since when, seconds, all of it has been what
/// `history` remembers and the viewer shows in its place: the same picture may be of a body that has moved, or from
/// before the camera has, and then the viewer has moved it away. `never` where it is not.
double examine_patch(RegionField const& field, Patch const& patch, std::span<DisplayFramelet const> framelets,
                     std::span<Framelet const> rendered, RenderedTimes times, RenderedMoment const& moment,
                     LumaHistory const& history, std::span<LumaHistory::Entry> entries,
                     std::span<RegionFindings> regions);

/// Takes the findings of a patch that was planned at `now` into account. `same_since`: what `examine_patch` returned;
/// `still_since`: when anything that is to be seen moved last. Returns whether the viewer needs the patch: false where
/// it holds the very same and `skips` is set. It is not set for what the mirror planned: samples that the viewer moves
/// take the place of what it holds there, be that finer or not.
bool learn_patch(RegionField& field, Patch const& patch, std::span<RegionFindings const> regions, double same_since,
                 double still_since, double now, bool skips);

/// Drift of a region since the rendering of it that was planned at `now`, which may have been a while ago.
float drift_since(Region const& region, double now);

/// Takes the answers to a region's probes into account: their luma now.
void learn_probes(Region& region, std::span<float const> luma, double now);

} // namespace framelet
