// What one viewer's picture gets next, adaptively: price -> choices -> density -> tiling -> selection, and learning
// from what was rendered. In: what is to be seen, when, how many samples a cycle has time for; then the framelets. Out:
// tiles and probes to render, and which of the framelets are worth sending. Batches may be planned before those before
// them are learnt: what has been taken is taken to become what the viewer holds, and is not taken again meanwhile.
#pragma once

#include <optional>
#include <vector>

#include "common/rays_per_sample.h"
#include "server/sampling/moment_refresh.h"
#include "server/schedule/patch_selection.h"
#include "server/schedule/place_learning.h"
#include "server/schedule/view_state.h"

namespace framelet {

/// Bounds of a cycle's length.
inline constexpr float least_cycle_seconds = 0.01f;
inline constexpr float most_cycle_seconds = 0.05f;
/// How long a cycle should be where planning one takes so long: planning may take a fortieth of it. `still`: nothing
/// moves, so that a long one costs no freshness.
float cycle_length(bool still, double plan_seconds);

struct RefreshInput {
    ViewState state; ///< what is to be seen at present
    std::optional<HeldMoment> moment; ///< what is rendered instead, while things move; nothing: the present
    double now = 0; ///< seconds, steady
    double samples_per_second = 0; ///< what there is time for, to render and to send
    /// What the renderer alone could do. Where that is more the link is what is scarce, and samples cost by the bytes
    /// that they take: `samples_per_second` are of the mean then. 0: the same.
    double rendered_per_second = 0;
    float cycle_seconds = least_cycle_seconds; ///< how often the response is worked out anew
    float delivery_seconds = 0; ///< from the end of its rendering until it shows
    float bias = 0;
    /// How bodies move, as the viewer knows it that moves what it holds along with them; null for one that does not.
    BodyMotions const* motions = nullptr;
    /// Most framelets of one batch; 0: what half a cycle has time for, so that it shows sooner, or all of it while
    /// nothing moves.
    std::size_t batch_framelets = 0;
    std::size_t link_framelets = max_batch_framelets; ///< most that the link takes at once
    ResponseLimits limits{};
};

/// What to render now.
struct RefreshPlan {
    double now = 0; ///< when
    double still_since = 0; ///< when anything moved last
    Viewport viewport;
    double moment_begun = 0; ///< when what is rendered was the present
    RenderedMoment moment; ///< whose motions must live until it is learnt
    bool is_new_cycle = false; ///< worked out anew, not what the last one left
    bool is_mirrored = false; ///< of a held moment, by what the viewer will see of it
    std::vector<Patch> patches;
    std::vector<std::size_t> tile_counts; ///< of each patch
    std::vector<Tile> tiles; ///< of the patches, in order
    int rays_per_sample = single_ray; ///< of the tiles
    /// Where what the moment shows is to be compared with what the viewer would.
    std::optional<MomentChecks> checks;
    std::vector<Probe> probes; ///< of the probed places, in order
    std::vector<std::uint32_t> probed; ///< places

    bool is_empty() const { return tiles.empty() && probes.empty() && !checks; }
    /// Through the samples of the tiles.
    std::size_t ray_count() const {
        return tiles.size() * framelet_samples * static_cast<std::size_t>(rays_per_sample);
    }
};

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

    /// Takes in what was rendered by a plan: display samples, the same with depth, luma of the probes. Plans are learnt
    /// once each and in order. Returns for each framelet whether the viewer needs it, which it does not where its
    /// picture has another size by now; valid until the next call.
    std::vector<std::uint8_t> const& learn(RefreshPlan const& plan, std::span<DisplayFramelet const> framelets,
                                           std::span<Framelet const> rendered, std::span<float const> probe_luma);

    /// The viewer gets those framelets of a plan for which `sent` (of the plan's tiles) is not 0, in a batch of
    /// this number, with these shapes, in order; sets how soon what they show fades. After `learn` of the same plan.
    void note_sent(RefreshPlan const& plan, std::uint64_t batch, std::span<DisplayFramelet const> framelets,
                   std::span<Framelet const> rendered, std::span<std::uint8_t const> sent,
                   std::span<FrameletShape> shapes);
    /// What is really to be seen of the moment of a plan that asks for it: inverse depths of the places of its grid, 1
    /// / metres, row by row; < 0: not known.
    void note_visibility(RefreshPlan const& plan, std::span<float const> inverse_depth);
    /// The viewer no longer holds these.
    void forget(std::span<SentTile const> framelets) { moments_.forget(framelets); }
    /// The viewer is told that it holds all of the picture.
    void settle() { moments_.settle(); }

    // To look at it.
    Mirror const& mirror() const { return moments_.mirror(); }
    PlaceField const& field() const { return field_; }
    Choices const& choices() const { return choices_; }
    float price() const { return price_; }
    /// The cycle that was planned last: how many there have been, its tiling, the patches to render, the samples
    /// that it has time for (by what they cost), the rays that each is made of, and its length.
    std::uint64_t cycle_count() const { return cycle_count_; }
    std::vector<Patch> const& cut() const { return cut_; }
    std::vector<Patch> const& cycle() const { return cycle_; }
    double cycle_budget() const { return cycle_budget_; }
    int rays_per_sample() const { return rays_per_sample_; }
    double cycle_seconds() const { return cycle_seconds_; }

private:
    bool goes_on(RefreshInput const& input, bool mirrored) const;
    void advance(RefreshInput const& input);
    void plan_cycle(RefreshInput const& input, RefreshPlan& plan);
    double plan_inspections(RefreshInput const& input);
    void find_costs(RefreshInput const& input);
    void plan_patches(RefreshInput const& input, double samples);
    void plan_moment(RefreshInput const& input, double samples, RefreshPlan& plan);
    void plan_probes(double samples, RefreshPlan& plan);
    void plan_refinement(double samples);
    void plan_completion(double samples);
    void plan_supersampling(double samples);
    void take_batch(std::size_t most_framelets, RefreshPlan& plan);
    void take(Patch const& patch, double now);
    void release(RefreshPlan const& plan);
    bool is_finest(std::uint32_t index) const;
    bool is_finished(std::uint32_t index) const;
    void note_supersampled(RefreshPlan const& plan);
    std::size_t place_count(Patch const& patch) const;
    void examine(RefreshPlan const& plan, std::span<DisplayFramelet const> framelets,
                 std::span<Framelet const> rendered);

    std::optional<ViewState> seen_;
    double advanced_ = 0; ///< the time that the field stands for
    double still_since_ = 0; ///< when what is to be seen changed last
    bool strayed_ = false; ///< something was rendered for another state than `seen_` since
    bool scene_moves_ = false;
    bool still_ = false; ///< what is to be seen is what the last plan was for
    PlaceField field_;
    LumaHistory history_;
    std::vector<LevelCosts> costs_; ///< of samples, by place; none where all cost the same
    /// Of a sample planned lately, as estimated. It begins below what pictures have, so that a slow link is not filled
    /// with the first of them (measured).
    float mean_bits_ = 1;
    Choices choices_;
    float price_ = 1e-6f;
    double planned_ = never; ///< when the cycle was planned
    std::uint64_t cycle_count_ = 0;
    double cycle_budget_ = 0; ///< samples
    double cycle_seconds_ = 0;
    std::vector<Patch> cycle_; ///< patches of the cycle
    int rays_per_sample_ = single_ray; ///< of the cycle
    std::size_t next_ = 0; ///< of these
    std::vector<std::uint8_t> send_;
    MomentRefresh moments_;

    // Scratch.
    std::vector<float> due_errors_;
    std::vector<float> density_;
    TilingScratch tiling_scratch_;
    std::vector<Patch> cut_;
    std::vector<RatedPatch> rated_;
    std::vector<std::uint32_t> suspects_;
    std::vector<std::pair<float, std::uint32_t>> unresolved_; ///< error and index of places
    std::vector<std::uint8_t> active_; ///< of the places: whether it moves
    std::vector<double> suspicions_;
    std::vector<LumaHistory::Entry> entries_; ///< of the framelets learnt from
    std::vector<PlaceFindings> findings_; ///< of the places of their patches
    std::vector<double> same_since_; ///< of the patches
    std::vector<std::pair<std::size_t, std::size_t>> firsts_; ///< first tile and first place of each patch
};

} // namespace framelet
