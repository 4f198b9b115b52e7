#include "server/sampling/plan/adaptive_refresh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/error.h"
#include "common/framelet/reprojection.h"

namespace framelet {
namespace {

/// The samples of so many seconds are planned together: what they cannot do at their price can wait. Before a camera
/// that moves they are fewer: what waits is elsewhere soon, and coarse everywhere is better than fine somewhere.
constexpr double planned_seconds = 0.2, planned_seconds_in_motion = 0.06;
/// A plan shows so many seconds late, besides what it takes to render.
constexpr double plan_overhead = 0.05;
/// Seconds by which the scene time may jump beyond four times what has passed; one that jumps farther has been set.
constexpr double most_time_step = 0.5;

bool is_cut(ViewState const& a, ViewState const& b, double seconds) {
    return a.exposure != b.exposure || std::abs(b.scene_time - a.scene_time) > seconds * 4 + most_time_step ||
           a.view.camera.projection != b.view.camera.projection;
}

/// Mean cost of a sample, taken from 1 towards it by `share` of the way.
float mean_cost(std::span<RatedPatch const> rated, float share) {
    double cost = 0, samples = 0;
    for (RatedPatch const& entry : rated) {
        cost += entry.cost;
        samples += entry.samples;
    }
    return samples > 0 ? 1 + share * (static_cast<float>(cost / samples) - 1) : 1.0f;
}

/// History that remembers nothing, for means of four rays: beside single rays they would seem to have changed.
LumaHistory const& no_history() {
    static LumaHistory const empty(1);
    return empty;
}

} // namespace

bool AdaptiveRefresh::is_complete(ViewState const& state) const {
    return seen_ && !strayed_ && same_picture(*seen_, state) &&
           std::ranges::all_of(field_.visible(),
                               [this](std::uint32_t index) { return is_finished(field_[index], still_since_); });
}

/// Brings the field to the present.
void AdaptiveRefresh::advance(RefreshInput const& input) {
    ViewState const& state = input.state;
    if (!seen_ || seen_->view.viewport != state.view.viewport) {
        field_ = RegionField(ImagePlane(state.view.viewport));
        history_.clear();
        moments_ = MomentRefresh(state.view.viewport);
        price_ = first_price;
        still_since_ = input.now;
        scene_moves_ = false;
    } else {
        double const seconds = std::max(input.now - planned_, 0.0);
        if (strayed_ || !same_picture(*seen_, state)) {
            still_since_ = input.now;
        }
        scene_moves_ = seen_->scene_time != state.scene_time;
        if (seen_->exposure != state.exposure) {
            moments_ = MomentRefresh(state.view.viewport);
        }
        if (is_cut(*seen_, state, seconds)) {
            invalidate(field_);
        } else {
            drift_on(field_, make_view_rays(seen_->view.camera, state.view.viewport),
                     make_view_rays(state.view.camera, state.view.viewport), scene_moves_, static_cast<float>(seconds));
        }
    }
    seen_ = state;
    strayed_ = false;
    planned_ = input.now;
}

/// Notes when a base begins: with another camera, and after samples that were not moved, whose cameras make no
/// difference to where the viewer holds them.
void AdaptiveRefresh::note_base(Camera const& camera, bool moves_samples, double now) {
    if (!moves_samples) {
        base_camera_.reset();
    } else if (base_camera_ != camera) {
        base_camera_ = camera;
        base_begun_ = now;
    }
}

/// True while the last cycle's plan still holds.
bool AdaptiveRefresh::goes_on(RefreshInput const& input, bool mirrored) const {
    double const seconds = input.now - planned_;
    return next_ < cycle_.size() && seconds < static_cast<double>(input.cycle_seconds) &&
           (mirrored || next_ < first_supersampled_ || same_picture(*seen_, input.state)) &&
           (!mirrored || moments_.is_planned(input.moment->begun)) &&
           seen_->view.viewport == input.state.view.viewport && !is_cut(*seen_, input.state, seconds);
}

void AdaptiveRefresh::plan(RefreshInput const& input, RefreshPlan& plan) {
    FRAMELET_CHECK(input.samples_per_second > 0 && input.cycle_seconds > 0);
    plan.patches.clear();
    plan.tile_counts.clear();
    plan.tiles.clear();
    plan.probes.clear();
    plan.probed.clear();
    plan.checks.reset();
    HeldMoment const moment = input.moment.value_or(HeldMoment{input.state, input.now});
    NumberedView const& view = moment.state.view;
    plan.now = input.now;
    plan.viewport = view.viewport;
    plan.moment_begun = moment.begun;
    plan.moment = {make_view_rays(view.camera, view.viewport), moment.state.scene_time,
                   is_reprojectable(view.camera) ? input.motions : nullptr};
    note_base(view.camera, plan.moment.motions != nullptr, input.now);
    plan.base_begun = base_begun_;
    plan.limits = input.limits;
    plan.is_mirrored = input.moment && plan.moment.motions != nullptr && input.limits.mirrors;
    still_ = !input.moment && is_still(input.state);
    plan.is_new_cycle = !goes_on(input, plan.is_mirrored);
    if (plan.is_new_cycle) {
        advance(input);
        plan_cycle(input, plan);
    }
    strayed_ = strayed_ || !same_picture(*seen_, moment.state);
    plan.still_since = strayed_ ? input.now : still_since_;
    take_batch(batch_limit(input, still_), plan);
}

void AdaptiveRefresh::plan_cycle(RefreshInput const& input, RefreshPlan& plan) {
    cycle_.clear();
    next_ = first_supersampled_ = 0;
    ++cycle_count_;
    cycle_seconds_ = static_cast<double>(input.cycle_seconds);
    cycle_budget_ = input.samples_per_second * cycle_seconds_;
    double samples = cycle_budget_;
    if (plan.is_mirrored) {
        plan_moment(input, samples, plan);
        return;
    }
    if (scene_moves_) {
        plan_probes(input.limits.probe_share * samples, plan);
        samples -= probe_cost * static_cast<double>(plan.probes.size());
        samples -= plan_periodic_refreshes(input);
    }
    plan_patches(input, samples);
    if (rated_.empty() && samples > 0) {
        input.moment ? select_refinement(field_, samples, unresolved_, cycle_)
                     : select_completion(field_, still_since_, scene_moves_, samples, cycle_);
    }
    first_supersampled_ = cycle_.size();
    if (cycle_.empty() && !scene_moves_) {
        select_supersampling(field_, still_since_, samples, unresolved_, cycle_);
    }
}

/// Plans periodic refreshes before all else of the cycle, so that they are not what is cut off when it takes longer
/// than expected. Returns the samples that they cost.
double AdaptiveRefresh::plan_periodic_refreshes(RefreshInput const& input) {
    Budget const budget{input.samples_per_second, input.cycle_seconds, input.delivery_seconds, input.bias,
                        input.limits};
    select_periodic_refreshes(field_, planned_, budget, suspects_, cycle_);
    double tiles = 0;
    for (Patch const& patch : cycle_) {
        tiles += tile_count(patch);
    }
    return tiles * framelet_samples;
}

/// Takes the next patches of the cycle that have equally many rays a sample, as many as a batch may hold, at least one
/// if any is left; in order of their regions, since neighbours are coded in fewer bytes beside each other.
void AdaptiveRefresh::take_batch(std::size_t most_framelets, RefreshPlan& plan) {
    bool const single = next_ < first_supersampled_ || next_ == cycle_.size();
    plan.rays_per_sample = single ? single_ray : four_rays;
    most_framelets /= static_cast<std::size_t>(plan.rays_per_sample);
    std::size_t tiles = 0;
    for (std::size_t const end = single ? first_supersampled_ : cycle_.size(); next_ < end; ++next_) {
        plan.tiles.clear();
        append_tiles(field_.plane(), cycle_[next_], plan.tiles);
        if (tiles > 0 && tiles + plan.tiles.size() > most_framelets) {
            break;
        }
        tiles += plan.tiles.size();
        plan.patches.push_back(cycle_[next_]);
    }
    std::ranges::sort(plan.patches, {},
                      [&](Patch const& patch) { return std::pair(field_.range_of(patch.node).first, patch.depth); });
    plan.tiles.clear();
    for (Patch const& patch : plan.patches) {
        std::size_t const before = plan.tiles.size();
        append_tiles(field_.plane(), patch, plan.tiles);
        plan.tile_counts.push_back(plan.tiles.size() - before);
        take(field_, patch, plan.now, plan.rays_per_sample);
    }
}

/// Finds what samples cost: all the same, unless the link is scarce.
void AdaptiveRefresh::find_costs(RefreshInput const& input) {
    costs_.clear();
    if (!(rays_a_sample(input) > 1)) {
        return;
    }
    costs_.assign(field_.size(), equal_costs);
    for (std::uint32_t const index : field_.visible()) {
        costs_[index] = coded_bits(field_[index].model);
        for (float& cost : costs_[index]) {
            cost /= mean_bits_;
        }
    }
}

void AdaptiveRefresh::plan_patches(RefreshInput const& input, double samples) {
    rated_.clear();
    if (samples <= 0) {
        return;
    }
    find_costs(input);
    double const batch_samples = static_cast<double>(batch_limit(input, still_) * framelet_samples);
    double const rendering = std::min(batch_samples, samples) / input.samples_per_second;
    Budget const budget{samples / static_cast<double>(input.cycle_seconds),
                        input.cycle_seconds,
                        static_cast<float>(rendering) + input.delivery_seconds,
                        input.bias,
                        input.limits,
                        costs_,
                        input.moment ? input.moment->begun : std::numeric_limits<double>::infinity(),
                        still_};
    find_due_errors(field_, budget, due_errors_);
    price_ = solve_price(field_, planned_, budget, due_errors_, price_, choices_);
    density_.assign(field_.size(), 0);
    for (std::uint32_t const index : field_.visible()) {
        density_[index] = samples_per_pixel(choices_[index].level);
    }
    make_density_patches(field_.plane(), density_, field_.depth(), tiling_scratch_, cut_);
    rate_patches(field_, choices_, due_errors_, cut_, budget, rated_);
    append_rated(samples, samples * rays_a_sample(input));
}

/// Appends to the cycle those of the rated patches that there is time for, to render and to send.
void AdaptiveRefresh::append_rated(double samples, double rays) {
    select_patches(samples, rays, rated_);
    if (!costs_.empty()) {
        mean_bits_ *= mean_cost(rated_, 0.2f);
    }
    std::size_t const periodic_refreshes = cycle_.size();
    auto const append = [&](int rays_per_sample) {
        for (RatedPatch const& entry : rated_) {
            if (entry.rays_per_sample == rays_per_sample) {
                append_new(entry.patch, periodic_refreshes, cycle_);
            }
        }
    };
    append(single_ray);
    first_supersampled_ = cycle_.size();
    append(four_rays);
}

/// Plans a cycle where what the viewer holds shows the moment worst.
void AdaptiveRefresh::plan_moment(RefreshInput const& input, double samples, RefreshPlan& plan) {
    double rays = samples * rays_a_sample(input);
    if (!moments_.looks_at(input.moment->begun)) {
        double const planned = rays_a_sample(input) * input.samples_per_second * planned_seconds;
        plan.checks = moments_.look(plan.moment, input.moment->begun, input.limits.visibility_share * planned,
                                    scene_moves_ ? input.limits.probe_share * planned : 0, plan.probes);
        rays -= plan.checks->cost(plan.viewport) + probe_cost * static_cast<double>(plan.probes.size());
        samples = std::min(samples, rays); // checks are rendered and not sent
    }
    find_costs(input);
    double const together =
        input.samples_per_second * (moments_.mirror().camera_stands() ? planned_seconds : planned_seconds_in_motion);
    MomentBudget const budget{input.limits.plans_together ? std::max(together, samples) : samples,
                              input.limits,
                              costs_,
                              input.moment->begun,
                              input.samples_per_second * plan_overhead,
                              static_cast<float>(rays_a_sample(input)),
                              input.bias};
    moments_.plan(field_, budget, rated_);
    append_rated(samples, rays);
}

/// Probes what seems to stand, the neighbours of what moves first.
void AdaptiveRefresh::plan_probes(double samples, RefreshPlan& plan) {
    auto const most = static_cast<std::size_t>(samples / (probe_cost * static_cast<double>(probes_per_region)));
    select_probed(field_, choices_, planned_, most, probe_scratch_, plan.probed);
    for (std::uint32_t const index : plan.probed) {
        Region& region = field_[index];
        region.asked = plan.now;
        plan.probes.insert(plan.probes.end(), region.probes.begin(),
                           region.probes.begin() + static_cast<std::ptrdiff_t>(region.probe_count));
    }
}

std::vector<std::uint8_t> const& AdaptiveRefresh::learn(RefreshPlan const& plan,
                                                        std::span<DisplayFramelet const> framelets,
                                                        std::span<Framelet const> rendered,
                                                        std::span<float const> probe_luma) {
    FRAMELET_CHECK(framelets.size() == plan.tiles.size() && rendered.size() == plan.tiles.size());
    FRAMELET_CHECK(probe_luma.size() == plan.probes.size());
    if (plan.viewport != field_.plane().viewport()) {
        send_.assign(framelets.size(), 0);
        return send_;
    }
    if (plan.checks && plan.checks->probe_spacing > 0) {
        moments_.note_looks(plan.moment, plan.probes, probe_luma, plan.checks->probe_spacing);
    }
    bool const supersampled = plan.rays_per_sample != single_ray;
    if (supersampled && !plan.is_mirrored) {
        learn_supersampled(field_, plan);
        release(field_, plan.patches, plan.now);
        send_.assign(framelets.size(), 1);
        return send_;
    }
    std::size_t probe = 0;
    for (std::uint32_t const index : plan.probed) {
        Region& region = field_[index];
        learn_probes(region, probe_luma.subspan(probe, region.probe_count), plan.now);
        probe += region.probe_count;
    }
    examine_batch(field_, plan, framelets, rendered, supersampled ? no_history() : history_, findings_);
    learn_batch(field_, plan, findings_, send_);
    release(field_, plan.patches, plan.now);
    if (supersampled) {
        learn_supersampled(field_, plan);
    } else {
        for (LumaHistory::Entry const& entry : findings_.entries) {
            history_.store(entry);
        }
    }
    return send_;
}

void AdaptiveRefresh::note_sent(RefreshPlan const& plan, std::uint64_t batch,
                                std::span<DisplayFramelet const> framelets, std::span<Framelet const> rendered,
                                std::span<std::uint8_t const> sent, std::span<FrameletShape> shapes) {
    if (plan.moment.motions != nullptr && plan.viewport == field_.plane().viewport()) {
        moments_.note_sent(plan.moment, batch, framelets, rendered, sent, shapes, plan.limits.expects_change);
    }
}

void AdaptiveRefresh::note_visibility(RefreshPlan const& plan, std::span<float const> inverse_depth) {
    if (plan.viewport == field_.plane().viewport()) {
        moments_.note_visibility(plan.moment, *plan.checks->visibility, inverse_depth);
    }
}

} // namespace framelet
