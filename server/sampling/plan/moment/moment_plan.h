// Plans what of a moment is rendered next: where the viewer would show holes, or what is coarse or worn, as far as
// samples lower that error most. In: what the viewer shows of the moment (mirror), what it holds of it and what is
// taken already (regions), samples. Out: patches, with what they gain for their samples.
//
// For a price of samples the best patches are found exactly: the levels that a tile may have form a quadtree, and from
// the leaves up a node is one tile where that gains more, less its price, than the best of its children together
// (pruning, [Chou 1989]). The price is the one at which they use the samples.
#pragma once

#include <array>
#include <vector>

#include "common/simd/lanes.h"
#include "server/render/rays_per_sample.h"
#include "server/sampling/held/coding_cost.h"
#include "server/sampling/held/region_grid.h"
#include "server/sampling/mirror/mirror.h"

namespace framelet {

/// Mean squared error of what a viewer fills a hole with.
inline constexpr float hole_error = 0.03f;

/// Growth of the error of samples for each pixel of spacing, as a multiple of the detail.
inline constexpr float error_growth = 1 + 4.0f / 9;

/// The bounds of what may be chosen and used. The evaluation narrows them, to see what each part is worth.
struct ResponseLimits {
    int least_level = 0, most_level = finest_level; ///< levels that may be chosen for a region
    double probe_share = 0.08; ///< share of the samples for probes of what the viewer shows, while the scene moves
    double visibility_share = 0.02; ///< share of the samples for visibility rays, which are not shaded
    bool expects_change = true; ///< decorrelation is expected of what turns, of outlines and of reflections
    bool plans_together = true; ///< the samples of several cycles are planned together; else each cycle on its own
    bool coarse_first = true; ///< where much is stale, all of it is rendered coarsely first
    int most_rays = four_rays; ///< most rays of a sample
};

/// A patch that is worth rendering.
struct RatedPatch {
    Patch patch;
    double samples = 0; ///< rays that it takes
    double cost = 0; ///< what it costs of the budget, in samples
    double urgency = 0; ///< what it gains for a sample of its cost, squared error summed over pixels, > 0
    int rays_per_sample = single_ray;
};

/// Keeps the most urgent, in order, until `budget` is spent or there are `most_samples`.
void select_most_urgent(double budget, double most_samples, std::vector<RatedPatch>& rated);

struct MomentBudget {
    double samples = 0; ///< most samples that the patches together may cost
    ResponseLimits limits{};
    /// Bits of a sample that costs one of `samples`, where the link is scarce; 0: all samples cost the same.
    float mean_bits = 0;
    double moment_begun = 0; ///< seconds; what has been rendered since then is of this moment
    double overhead = 0; ///< samples that a plan costs besides, be it short or long
    float rays = 1; ///< rays that there is time for, for each of `samples`; above 1 where the link is scarce
    float bias = 0; ///< -1 (spatial fidelity) .. 1 (temporal)
    bool rests = false; ///< nothing moves: what is rendered stays where it is, and shows in the end
};

class MomentPlan {
public:
    /// One figure for each level, then one for samples of four rays at a sample a pixel; a spare one at the end makes
    /// them a vector.
    using ChoiceFigures = std::array<float, lane_count>;
    static constexpr std::size_t supersampled = sampling_levels, no_choice = supersampled + 1;
    static_assert(supersampled < std::tuple_size_v<ChoiceFigures>);

    /// Replaces `rated` by disjoint patches, unsorted. `mirror` looks at the moment, with the viewport of `regions`; it
    /// is the same mirror in all calls, since what has not changed in it since the last one is not rated again.
    void find(Mirror const& mirror, RegionGrid const& regions, MomentBudget const& budget,
              std::vector<RatedPatch>& rated);

private:
    struct Node {
        float gain = 0, cost = 0; ///< as one tile; cost 0: it may not be one
        float best = 0; ///< gain less price
        float spent = 0; ///< cost of the best
        bool whole = false; ///< one tile is best
    };
    struct Leaf {
        ChoiceFigures gain{}, cost{};
        float stale = 0, wrong = 0; ///< squared error summed over pixels: by changed looks, all of it
        float detail = 0, shown = 0; ///< summed over cells that show something; their number
        int had = -1; ///< level of what is of this moment already; -1: none
        bool is_rated = false; ///< nothing has changed since its gains were found
        std::size_t choice = no_choice; ///< best
    };

    /// Mean detail of what shows in a region; where nothing does, of the whole picture.
    float detail_of(Leaf const& leaf) const { return leaf.shown > 0 ? leaf.detail / leaf.shown : mean_detail_; }
    void find_gains(Mirror const& mirror, RegionGrid const& regions, MomentBudget const& budget);
    bool knows(Mirror const& mirror, MomentBudget const& budget) const;
    void find_detail(Mirror const& mirror, RegionGrid const& regions, std::uint32_t index);
    void rate(Mirror const& mirror, RegionGrid const& regions, std::uint32_t index, MomentBudget const& budget);
    void find_costs(RegionGrid const& regions, std::uint32_t index, MomentBudget const& budget);
    void sum_nodes(RegionGrid const& regions, MomentBudget const& budget);
    void choose_horizon(RegionGrid const& regions, MomentBudget const& budget, float least);
    double solve(RegionGrid const& regions, MomentBudget const& budget, float price);
    void collect(RegionGrid const& regions, int depth, std::uint32_t index, std::vector<RatedPatch>& rated) const;

    float gain_ = 0; ///< of what was chosen last
    float mean_detail_ = 0;
    float stale_ = 0, wrong_ = 0; ///< of all leaves
    std::vector<Leaf> leaves_; ///< of the regions
    std::uint64_t changes_ = 0, looked_ = 0; ///< of the mirror, for which the leaves were rated
    float bias_ = 0; ///< likewise
    bool rests_ = false; ///< likewise
    std::vector<std::vector<Node>> nodes_; ///< by depth, above the regions
};

} // namespace framelet
