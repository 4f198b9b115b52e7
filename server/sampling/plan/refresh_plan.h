// Values that adaptive refresh is asked by and answers with. In: what is to be seen, when, how many samples a cycle has
// time for. Out: tiles and probes to render, how long a cycle and how large a batch should be.
#pragma once

#include <optional>
#include <vector>

#include "server/sampling/plan/completion.h"
#include "server/sampling/plan/moment/moment_refresh.h"
#include "server/sampling/plan/view_state.h"

namespace framelet {

/// The bounds of a cycle's length, seconds.
inline constexpr float least_cycle_seconds = 0.01f;
inline constexpr float most_cycle_seconds = 0.05f;
/// Length of a cycle, seconds, where planning one takes `plan_seconds`: planning may take a fortieth of it. `still`:
/// nothing moves, so that a long one costs no freshness.
float cycle_length(bool still, double plan_seconds);

struct RefreshInput {
    ViewState state; ///< what is to be seen at present
    std::optional<HeldMoment> moment; ///< what is rendered instead, while things move; nothing: the present
    double now = 0; ///< seconds, steady
    double samples_per_second = 0; ///< what there is time for, to render and to send
    /// Samples a second that the renderer alone could do; 0: the same. Where that is more, the link is scarce, and
    /// samples cost by the bytes that they take: `samples_per_second` then counts samples of mean cost.
    double rendered_per_second = 0;
    float cycle_seconds = least_cycle_seconds; ///< length of a cycle, after which another one is planned
    float bias = 0; ///< -1 (spatial fidelity) .. 1 (temporal)
    BodyMotions const* motions = nullptr; ///< of bodies, as the viewer knows them or would; not null
    bool moves_samples = true; ///< the viewer moves what it holds, where cameras let it
    bool light_changes = false; ///< more is learnt of the light, also where all stands
    /// The largest number of framelets of one batch; 0: what half a cycle has time for, so that it shows sooner, or all
    /// of it while nothing moves.
    std::size_t batch_framelets = 0;
    std::size_t link_framelets = max_batch_framelets; ///< most that the link takes at once
    std::size_t least_framelets = 1; ///< of a batch, so that all who render have some, whatever there is time for
    ResponseLimits limits{};
    Completion completion{};
};

/// Rays that there is time to render for each sample that there is time to render and to send.
double rays_a_sample(RefreshInput const& input);

/// Returns the largest number of framelets that a batch may have. `still`: nothing moves, so that a large batch costs
/// no freshness.
std::size_t batch_limit(RefreshInput const& input, bool still);

/// The work of one batch: what to render now.
struct RefreshPlan {
    double now = 0; ///< when it was made, seconds
    Viewport viewport;
    double moment_begun = 0; ///< when what is rendered was the present, seconds
    RenderedMoment moment; ///< whose motions must live until it is learnt
    std::uint64_t camera = 0; ///< number of its camera
    bool is_new_cycle = false; ///< the cycle was planned anew; false: this is more of the last one
    /// The viewer moves what is rendered to other moments: it takes the place of what was there, be that the same. Else
    /// what the viewer shows already is not sent again.
    bool will_be_moved = false;
    ResponseLimits limits{}; ///< by which the plan was made
    Completion completion{}; ///< likewise
    std::vector<Patch> patches;
    std::vector<std::size_t> tile_counts; ///< of each patch
    std::vector<Tile> tiles; ///< of the patches, in order
    int rays_per_sample = single_ray; ///< of the tiles, once they are rendered
    /// Positions at which what the moment shows is to be compared with what the viewer would show.
    std::optional<MomentChecks> checks;
    std::vector<Probe> probes;

    bool is_empty() const { return tiles.empty() && probes.empty() && !checks; }
    /// Number of rays through the samples of the tiles, those that they had before not counted.
    std::size_t ray_count() const {
        return tiles.size() * framelet_samples * static_cast<std::size_t>(new_rays(rays_per_sample));
    }
};

} // namespace framelet
