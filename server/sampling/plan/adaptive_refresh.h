// Decides what one viewer's picture gets next, and learns from what was rendered. In: what is to be seen, when, how
// many samples a cycle has time for; then the framelets. Out: tiles and checks to render, and which of the framelets
// are worth sending. A batch may be planned before earlier ones are learnt: what has been taken counts as what the
// viewer will hold, and is not taken again meanwhile.
//
// There is one plan for all: of a moment while things move, of the present once they stand, for viewers that move what
// they hold and for those that do not. Only once nothing is worth its samples any more is a picture that stands
// completed whatever the plan says.
#pragma once

#include <optional>
#include <vector>

#include "server/sampling/held/held_tiles.h"
#include "server/sampling/plan/refresh_plan.h"

namespace framelet {

class AdaptiveRefresh {
public:
    /// True when the picture of `state` is complete, as far as is learnt: `plan` would find nothing.
    bool is_complete(ViewState const& state) const;

    /// True when the last plan was for the same picture: nothing moves, and large batches cost no freshness.
    bool is_still(ViewState const& state) const { return seen_ && same_picture(*seen_, state); }

    /// Writes the next batch's work to `plan`: of the cycle that was planned last while that lasts, or of a new one, so
    /// that small batches do not plan more often than large ones. Time goes on from call to call. While something is
    /// not learnt yet an empty plan only says that there is nothing else.
    void plan(RefreshInput const& input, RefreshPlan& plan);

    /// Takes in what was rendered by a plan: display samples, the same with depth, looks of the probes. `errors`: mean
    /// squared error left in each framelet; empty: the samples are to tell. Plans are learnt once each and in order.
    /// Returns for each framelet whether the viewer needs it, which it does not where it shows the same already, or its
    /// picture has another size by now; valid until the next call.
    std::vector<std::uint8_t> const& learn(RefreshPlan const& plan, std::span<DisplayFramelet const> framelets,
                                           std::span<Framelet const> rendered, ProbeLooks const& looks,
                                           std::span<float const> errors = {});

    /// Notes that the viewer gets those framelets of a plan for which `sent` (of the plan's tiles) is not 0, in a batch
    /// of this number, with these shapes, in order; sets how soon what they show fades. After `learn` of the same plan.
    /// `framelets` are as probes see them.
    void note_sent(RefreshPlan const& plan, std::uint64_t batch, std::span<DisplayFramelet const> framelets,
                   std::span<Framelet const> rendered, std::span<std::uint8_t const> sent,
                   std::span<FrameletShape> shapes);
    /// Takes in what is really to be seen of the moment of a plan that asks for it: inverse depths at the positions of
    /// its grid, 1 / metres, row by row; < 0: not known.
    void note_visibility(RefreshPlan const& plan, std::span<float const> inverse_depth);
    /// Notes that the viewer no longer holds these.
    void forget(std::span<SentTile const> framelets) { moments_.forget(framelets); }
    /// Notes that the viewer is told that it holds all of the picture.
    void settle() { moments_.settle(); }

    /// What the viewer got last at each place.
    HeldTiles& held_tiles() { return held_tiles_; }
    HeldTiles const& held_tiles() const { return held_tiles_; }

    // These let others look at what it decides.
    Mirror const& mirror() const { return moments_.mirror(); }
    RegionGrid const& regions() const { return regions_; }
    /// The cycle that was planned last: how many there have been, the samples that it has time for (by what they cost),
    /// and its length.
    std::uint64_t cycle_count() const { return cycle_count_; }
    double cycle_budget() const { return cycle_budget_; }
    double cycle_seconds() const { return cycle_seconds_; }

private:
    void see(RefreshInput const& input);
    bool goes_on(RefreshInput const& input, HeldMoment const& moment) const;
    double planned_together(RefreshInput const& input, RefreshPlan const& plan) const;
    void plan_cycle(RefreshInput const& input, double begun, RefreshPlan& plan);
    void append_rated(double samples, double rays, bool prices_bytes);
    void take_batch(std::size_t most_framelets, RefreshPlan& plan);

    std::optional<ViewState> seen_; ///< what the last plan was for: the present
    Completion completion_; ///< of the last plan
    double still_since_ = 0; ///< when what is to be seen changed last, seconds
    bool strayed_ = false; ///< something was rendered for another state than `seen_` since
    bool moves_samples_ = true; ///< of the last plan
    std::optional<Camera> camera_; ///< of the last plan
    std::uint64_t cameras_ = 0; ///< counts those for which a viewer moves all that it holds
    ViewState planned_state_; ///< that the cycle renders
    double planned_ = never; ///< when the cycle was planned, seconds
    bool scene_moves_ = false;
    RegionGrid regions_;
    HeldTiles held_tiles_;
    MomentRefresh moments_;
    /// Mean bits of a sample planned lately, as estimated. It begins below what pictures have, so that a slow link is
    /// not filled with the first of them (measured).
    float mean_bits_ = 1;
    std::uint64_t cycle_count_ = 0;
    double cycle_budget_ = 0; ///< samples
    double cycle_seconds_ = 0;
    std::vector<Patch> cycle_; ///< patches of the cycle
    std::size_t first_supersampled_ = 0; ///< index in `cycle_` from which on each sample is made of several rays
    int supersampling_ = four_rays; ///< how many
    std::size_t next_ = 0; ///< index in `cycle_` of the patch that is taken next
    std::vector<std::uint8_t> send_;
    std::vector<std::uint64_t> contents_; ///< scratch
    std::vector<RatedPatch> rated_; ///< scratch
};

} // namespace framelet
