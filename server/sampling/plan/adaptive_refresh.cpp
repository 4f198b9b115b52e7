#include "server/sampling/plan/adaptive_refresh.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "common/framelet/reprojection.h"
#include "server/sampling/plan/completion.h"

namespace framelet {
namespace {

/// Checks of a moment have a share of the samples of so many seconds.
constexpr double checked_seconds = 0.2;
/// A plan shows so many seconds late, besides what it takes to render.
constexpr double plan_overhead = 0.05;

/// Mean cost of a sample, taken from 1 towards it by `share` of the way.
float mean_cost(std::span<RatedPatch const> rated, float share) {
    double cost = 0, samples = 0;
    for (RatedPatch const& entry : rated) {
        cost += entry.cost;
        samples += entry.samples;
    }
    return samples > 0 ? 1 + share * (static_cast<float>(cost / samples) - 1) : 1.0f;
}

/// True where a viewer that moves its samples moves something of this framelet by itself.
bool shows_motion(Framelet const& framelet) {
    return std::ranges::any_of(framelet.body, [](BodyNumber body) { return body != static_body; }) ||
           std::ranges::any_of(framelet.drift, [](Drift const& drift) { return drift.any(); });
}

} // namespace

bool AdaptiveRefresh::is_complete(ViewState const& state) const {
    return seen_ && !strayed_ && same_picture(*seen_, state) &&
           std::ranges::all_of(regions_.visible(), [this](std::uint32_t index) {
               return is_finished(regions_[index], still_since_, completion_);
           });
}

/// Takes in what is to be seen.
void AdaptiveRefresh::see(RefreshInput const& input) {
    ViewState const& state = input.state;
    bool const is_another = !seen_ || seen_->view.viewport != state.view.viewport;
    if (is_another) {
        regions_ = RegionGrid(ImagePlane(state.view.viewport));
        held_tiles_ = HeldTiles(regions_.plane());
    }
    bool const is_other_kind = is_another || moves_samples_ != input.moves_samples;
    if (is_other_kind || seen_->transform != state.transform ||
        seen_->view.camera.projection != state.view.camera.projection) {
        moments_ = MomentRefresh(state.view.viewport);
        held_tiles_.forget_contents();
        ++cameras_;
    }
    moves_samples_ = input.moves_samples;
    completion_ = input.completion;
    if (is_other_kind || strayed_ || !same_picture(*seen_, state)) {
        still_since_ = input.now;
    }
    scene_moves_ = !is_another && seen_->scene_time != state.scene_time;
    seen_ = state;
    strayed_ = false;
    planned_ = input.now;
}

/// True while the last cycle's plan still holds.
bool AdaptiveRefresh::goes_on(RefreshInput const& input, HeldMoment const& moment) const {
    return next_ < cycle_.size() && input.now - planned_ < static_cast<double>(input.cycle_seconds) &&
           (input.moment ? moments_.is_planned(moment.begun) : is_still(input.state) && !strayed_) &&
           planned_state_.view.viewport == moment.state.view.viewport && same_picture(planned_state_, moment.state);
}

void AdaptiveRefresh::plan(RefreshInput const& input, RefreshPlan& plan) {
    FRAMELET_CHECK(input.samples_per_second > 0 && input.cycle_seconds > 0 && input.motions != nullptr);
    plan.patches.clear();
    plan.tile_counts.clear();
    plan.tiles.clear();
    plan.probes.clear();
    plan.checks.reset();
    HeldMoment moment = input.moment.value_or(HeldMoment{input.state, still_since_});
    bool const still = !input.moment && is_still(input.state);
    plan.is_new_cycle = !goes_on(input, moment);
    if (plan.is_new_cycle) {
        see(input);
        moment.begun = input.moment ? moment.begun : still_since_;
        planned_state_ = moment.state;
    }
    NumberedView const& view = moment.state.view;
    plan.now = input.now;
    plan.viewport = view.viewport;
    plan.moment_begun = input.moment ? moment.begun : input.now;
    bool const moves_samples = input.moves_samples && is_reprojectable(view.camera);
    plan.moment = {make_view_rays(view.camera, view.viewport), moment.state.scene_time, input.motions, moves_samples,
                   input.light_changes};
    plan.will_be_moved = input.moment && moves_samples;
    plan.limits = input.limits;
    plan.completion = input.completion;
    if (moves_samples && camera_ != view.camera) { // the viewer moves all that it holds
        held_tiles_.forget_contents();
        ++cameras_;
    }
    camera_ = view.camera;
    plan.camera = cameras_;
    strayed_ = strayed_ || !same_picture(*seen_, moment.state);
    if (plan.is_new_cycle) {
        plan_cycle(input, moment.begun, plan);
    }
    take_batch(batch_limit(input, still), plan);
}

/// Seconds whose samples are planned together: what they cannot do at their price can wait. Before a camera that moves
/// they are fewer: what waits is elsewhere soon, and coarse everywhere is better than fine somewhere. Of what stands
/// they are more: each place is rendered rather once and finely than in steps. With a viewer that moves nothing all
/// that waits gets worse.
double AdaptiveRefresh::planned_together(RefreshInput const& input, RefreshPlan const& plan) const {
    if (!input.moment) {
        return 0.5;
    }
    if (!plan.moment.moves_samples) {
        return 0;
    }
    return moments_.mirror().camera_stands() ? 0.14 : 0.06;
}

/// Plans a cycle where what the viewer holds shows the moment worst; of a picture that stands, what it lacks.
void AdaptiveRefresh::plan_cycle(RefreshInput const& input, double begun, RefreshPlan& plan) {
    cycle_.clear();
    next_ = first_supersampled_ = 0;
    supersampling_ = four_rays;
    ++cycle_count_;
    cycle_seconds_ = static_cast<double>(input.cycle_seconds);
    cycle_budget_ = input.samples_per_second * cycle_seconds_;
    double samples = cycle_budget_;
    double rays = samples * rays_a_sample(input);
    if (!moments_.looks_at(begun)) {
        double const checked = input.moment ? rays_a_sample(input) * input.samples_per_second * checked_seconds : 0;
        MomentChecks const checks =
            moments_.look(plan.moment, begun, input.limits.visibility_share * checked,
                          scene_moves_ || input.light_changes ? input.limits.probe_share * checked : 0, plan.probes);
        rays -= checks.cost(plan.viewport) + probe_cost * static_cast<double>(plan.probes.size());
        samples = std::min(samples, rays); // checks are rendered and not sent
        if (input.moment) { // what stands is all rendered anew in the end
            plan.checks = checks;
        }
    }
    bool const prices_bytes = rays_a_sample(input) > 1;
    double const together = input.limits.plans_together ? input.samples_per_second * planned_together(input, plan) : 0;
    MomentBudget const budget{std::max(together, samples),
                              input.limits,
                              prices_bytes ? mean_bits_ : 0,
                              begun,
                              input.samples_per_second * plan_overhead,
                              static_cast<float>(rays_a_sample(input)),
                              input.bias,
                              !input.moment};
    moments_.plan(regions_, budget, rated_);
    append_rated(samples, rays, prices_bytes);
    if (cycle_.empty() && !input.moment) {
        select_finest(regions_, still_since_, completion_, samples, cycle_);
        first_supersampled_ = cycle_.size();
        if (cycle_.empty()) {
            supersampling_ = select_supersampling(regions_, still_since_, completion_, samples, cycle_);
        }
    }
}

/// Appends to the cycle those of the rated patches that there is time for, to render and to send.
void AdaptiveRefresh::append_rated(double samples, double rays, bool prices_bytes) {
    select_most_urgent(samples, rays, rated_);
    if (prices_bytes) {
        mean_bits_ *= mean_cost(rated_, 0.2f);
    }
    auto const append = [&](int rays_per_sample) {
        for (RatedPatch const& entry : rated_) {
            if (entry.rays_per_sample == rays_per_sample) {
                cycle_.push_back(entry.patch);
            }
        }
    };
    append(single_ray);
    first_supersampled_ = cycle_.size();
    append(four_rays);
}

/// Takes the next patches of the cycle that have equally many rays a sample, as many as a batch may hold, at least one
/// if any is left; in order of their regions, since neighbours are coded in fewer bytes beside each other.
void AdaptiveRefresh::take_batch(std::size_t most_framelets, RefreshPlan& plan) {
    bool const single = next_ < first_supersampled_ || next_ == cycle_.size();
    plan.rays_per_sample = single ? single_ray : supersampling_;
    most_framelets /= static_cast<std::size_t>(new_rays(plan.rays_per_sample));
    std::size_t tiles = 0;
    for (std::size_t const end = single ? first_supersampled_ : cycle_.size(); next_ < end; ++next_) {
        plan.tiles.clear();
        append_tiles(regions_.plane(), cycle_[next_], plan.tiles);
        if (tiles > 0 && tiles + plan.tiles.size() > most_framelets) {
            break;
        }
        tiles += plan.tiles.size();
        plan.patches.push_back(cycle_[next_]);
    }
    std::ranges::sort(plan.patches, {},
                      [&](Patch const& patch) { return std::pair(regions_.first_under(patch.node), patch.depth); });
    plan.tiles.clear();
    for (Patch const& patch : plan.patches) {
        std::size_t const before = plan.tiles.size();
        append_tiles(regions_.plane(), patch, plan.tiles);
        plan.tile_counts.push_back(plan.tiles.size() - before);
        regions_.take(patch, plan.now, plan.rays_per_sample);
    }
}

std::vector<std::uint8_t> const& AdaptiveRefresh::learn(RefreshPlan const& plan,
                                                        std::span<DisplayFramelet const> framelets,
                                                        std::span<Framelet const> rendered, ProbeLooks const& looks,
                                                        std::span<float const> errors) {
    FRAMELET_CHECK(framelets.size() == plan.tiles.size() && rendered.size() == plan.tiles.size());
    FRAMELET_CHECK(errors.empty() || errors.size() == plan.tiles.size());
    FRAMELET_CHECK(looks.luma.size() == plan.probes.size());
    if (plan.viewport != regions_.plane().viewport()) {
        send_.assign(framelets.size(), 0);
        return send_;
    }
    if (plan.checks && plan.checks->probe_spacing > 0) {
        moments_.note_looks(plan.moment, plan.probes, looks, plan.checks->probe_spacing);
    }
    if (!are_shown(plan.rays_per_sample)) {
        send_.assign(framelets.size(), 0);
        for (Patch const& patch : plan.patches) {
            regions_.note_held(patch, plan.now, plan.rays_per_sample);
        }
        return send_;
    }
    send_.assign(framelets.size(), 1);
    contents_.resize(framelets.size());
    tbb::parallel_for(std::size_t{0}, framelets.size(), [&](std::size_t i) {
        bool const moves = plan.moment.moves_samples && (plan.camera != cameras_ || shows_motion(rendered[i]));
        contents_[i] = moves ? 0 : content_of(framelets[i]);
    });
    bool const means = plan.rays_per_sample != single_ray;
    std::size_t first = 0;
    for (std::size_t p = 0; p < plan.patches.size(); ++p) {
        Patch const& patch = plan.patches[p];
        std::size_t const end = first + plan.tile_counts[p];
        bool const is_finest = regions_.level_of(patch.depth) == plan.completion.finest;
        if (is_finest && (!means || !errors.empty())) {
            float const left = errors.empty() ? error_left(framelets.subspan(first, end - first))
                                              : std::ranges::max(errors.subspan(first, end - first));
            std::ranges::for_each(regions_[patch], [left](Region& region) { region.left = left; });
        }
        // Means stay where single rays say that there are to be means again.
        bool const keeps_means = means || (is_finest && regions_[patch].front().left > plan.completion.enough);
        for (; first < end; ++first) {
            Tile const tile = plan.tiles[first];
            bool const same = contents_[first] != 0 && held_tiles_.shows(tile, contents_[first], means) &&
                              (keeps_means || !held_tiles_.shows_means(tile));
            bool const sends = !same || plan.will_be_moved;
            send_[first] = sends ? 1 : 0;
            if (sends) { // single rays that have not changed still hide the means of before
                held_tiles_.put(tile, contents_[first], means);
            }
        }
        regions_.note_held(patch, plan.now, plan.rays_per_sample);
    }
    return send_;
}

void AdaptiveRefresh::note_sent(RefreshPlan const& plan, std::uint64_t batch,
                                std::span<DisplayFramelet const> framelets, std::span<Framelet const> rendered,
                                std::span<std::uint8_t const> sent, std::span<FrameletShape> shapes) {
    if (plan.viewport == regions_.plane().viewport()) {
        moments_.note_sent(plan.moment, batch, framelets, rendered, sent, shapes, plan.limits.expects_change);
    }
}

void AdaptiveRefresh::note_visibility(RefreshPlan const& plan, std::span<float const> inverse_depth) {
    if (plan.viewport == regions_.plane().viewport()) {
        moments_.note_visibility(plan.moment, *plan.checks->visibility, inverse_depth);
    }
}

} // namespace framelet
