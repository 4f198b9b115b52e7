// Learns from what was rendered by a plan, all of its patches together. In: framelets. Out: what they say of the field,
// the field brought up to date, and which framelets the viewer needs.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "server/sampling/field/region_learning.h"
#include "server/sampling/plan/refresh_plan.h"

namespace framelet {

struct BatchFindings {
    std::vector<std::pair<std::size_t, std::size_t>> firsts; ///< first tile and first region of each patch
    std::vector<LumaHistory::Entry> entries; ///< one of each framelet
    std::vector<RegionFindings> regions; ///< one of each region of the patches
    std::vector<double> same_since; ///< by patch, as `examine_patch` says
};

/// Replaces `findings` by what the framelets of a plan say, of all patches in parallel. `history`: an empty one where
/// samples are means of four rays, since beside single ones they would seem to have changed.
void examine_batch(RegionField const& field, RefreshPlan const& plan, std::span<DisplayFramelet const> framelets,
                   std::span<Framelet const> rendered, LumaHistory const& history, BatchFindings& findings);

/// Takes the findings into account; replaces `needed` by whether the viewer needs each framelet.
void learn_batch(RegionField& field, RefreshPlan const& plan, BatchFindings const& findings,
                 std::vector<std::uint8_t>& needed);

/// Notes that the viewer holds what a plan shows with four rays a sample. At rest that is all that is learnt of such a
/// plan.
void learn_supersampled(RegionField& field, RefreshPlan const& plan);

} // namespace framelet
