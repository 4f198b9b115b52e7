#include "server/schedule/adaptive_refresh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "common/reprojection.h"

namespace framelet {
namespace {

/// A place is probed again after so many seconds, sooner beside something that moves.
constexpr double probe_period = 0.25;
/// What should have been refreshed by then, and has not, is probed after so many.
constexpr double most_unseen = 0.5;
/// Mean squared error of the finest samples, as modelled, above which they are not enough of a still picture.
constexpr float enough = 5e-5f;
/// The samples of so many seconds are planned together: what they cannot do at their price can wait.
constexpr double planned_seconds = 0.2;
/// A plan shows so many seconds late, besides what it takes to render.
constexpr double plan_overhead = 0.05;
/// A scene time that jumps by more than this over what has passed has been set.
constexpr double most_time_step = 0.5;

bool is_cut(ViewState const& a, ViewState const& b, double seconds) {
    return a.exposure != b.exposure || std::abs(b.scene_time - a.scene_time) > seconds * 4 + most_time_step ||
           a.view.camera.projection != b.view.camera.projection;
}

/// `still`: nothing moves, so that a large batch costs no freshness.
std::size_t batch_limit(RefreshInput const& input, bool still) {
    if (input.batch_framelets > 0) {
        return std::min({input.batch_framelets, input.link_framelets, max_batch_framelets});
    }
    double const share = still ? 2 : 0.5; // half a cycle shows sooner
    double const timely =
        share * input.samples_per_second * static_cast<double>(input.cycle_seconds) / framelet_samples;
    return static_cast<std::size_t>(
        std::clamp(timely, 1.0, static_cast<double>(std::min(input.link_framelets, max_batch_framelets))));
}

/// Of a sample, taken so far from 1.
float mean_cost(std::span<RatedPatch const> rated, float share) {
    double cost = 0, samples = 0;
    for (RatedPatch const& entry : rated) {
        cost += entry.cost;
        samples += entry.samples;
    }
    return samples > 0 ? 1 + share * (static_cast<float>(cost / samples) - 1) : 1.0f;
}

} // namespace

float cycle_length(bool still, double plan_seconds) {
    return still ? most_cycle_seconds
                 : std::clamp(static_cast<float>(40 * plan_seconds), least_cycle_seconds, most_cycle_seconds);
}

/// The viewer holds the finest samples of this picture, as far as is learnt.
bool AdaptiveRefresh::is_finest(std::uint32_t index) const {
    Place const& place = field_[index];
    return place.level == sampling_levels - 1 && place.rendered >= still_since_;
}

bool AdaptiveRefresh::is_finished(std::uint32_t index) const {
    Place const& place = field_[index];
    return is_finest(index) && (place.supersampled >= still_since_ || place.left <= enough);
}

bool AdaptiveRefresh::is_complete(ViewState const& state) const {
    return seen_ && !strayed_ && same_picture(*seen_, state) &&
           std::all_of(field_.visible().begin(), field_.visible().end(),
                       [this](std::uint32_t index) { return is_finished(index); });
}

/// Brings the field to the present.
void AdaptiveRefresh::advance(RefreshInput const& input) {
    ViewState const& state = input.state;
    if (!seen_ || seen_->view.viewport != state.view.viewport) {
        field_ = PlaceField(ImagePlane(state.view.viewport));
        history_.clear();
        moments_ = MomentRefresh(state.view.viewport);
        price_ = 1e-6f;
        still_since_ = input.now;
        scene_moves_ = false;
    } else {
        double const seconds = std::max(input.now - advanced_, 0.0);
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
    advanced_ = input.now;
}

/// True while the last cycle's plan still holds.
bool AdaptiveRefresh::goes_on(RefreshInput const& input, bool mirrored) const {
    double const seconds = input.now - planned_;
    return next_ < cycle_.size() && seconds < static_cast<double>(input.cycle_seconds) &&
           (rays_per_sample_ == single_ray || same_picture(*seen_, input.state)) &&
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
    plan.is_mirrored = input.moment && plan.moment.motions != nullptr;
    still_ = !input.moment && is_still(input.state);
    plan.is_new_cycle = !goes_on(input, plan.is_mirrored);
    if (plan.is_new_cycle) {
        advance(input);
        plan_cycle(input, plan);
    }
    strayed_ = strayed_ || !same_picture(*seen_, moment.state);
    plan.still_since = strayed_ ? input.now : still_since_;
    plan.rays_per_sample = rays_per_sample_;
    take_batch(batch_limit(input, still_) / static_cast<std::size_t>(rays_per_sample_), plan);
}

void AdaptiveRefresh::plan_cycle(RefreshInput const& input, RefreshPlan& plan) {
    planned_ = input.now;
    cycle_.clear();
    rays_per_sample_ = single_ray;
    next_ = 0;
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
        samples -= plan_inspections(input);
    }
    plan_patches(input, samples);
    if (rated_.empty() && samples > 0) {
        input.moment ? plan_refinement(samples) : plan_completion(samples);
    }
    if (cycle_.empty() && !scene_moves_) {
        plan_supersampling(samples);
    }
}

/// Before all else of the cycle, so that they are not what is cut off when it takes longer than expected. Returns what
/// they cost.
double AdaptiveRefresh::plan_inspections(RefreshInput const& input) {
    Budget const budget{input.samples_per_second, input.cycle_seconds, input.delivery_seconds, input.bias,
                        input.limits};
    select_inspections(field_, advanced_, budget, suspects_, cycle_);
    double tiles = 0;
    for (Patch const& patch : cycle_) {
        tiles += tile_count(patch);
    }
    return tiles * framelet_samples;
}

/// The next patches of the cycle, as many as a batch may hold, at least one; in order of their places, since neighbours
/// are coded in fewer bytes beside each other.
void AdaptiveRefresh::take_batch(std::size_t most_framelets, RefreshPlan& plan) {
    std::size_t tiles = 0;
    for (; next_ < cycle_.size(); ++next_) {
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
        take(patch, plan.now);
    }
}

void AdaptiveRefresh::take(Patch const& patch, double now) {
    PlaceField::Range const range = field_.range_of(patch.node);
    for (std::uint32_t i = range.first; i < range.last; ++i) {
        field_[i].taken = {field_.level_of(patch.depth), 0, now};
        field_[i].asked = now;
    }
}

/// Samples cost the same unless the link is what is scarce.
void AdaptiveRefresh::find_costs(RefreshInput const& input) {
    costs_.clear();
    if (!(input.rendered_per_second > input.samples_per_second)) {
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
    price_ = solve_price(field_, advanced_, budget, due_errors_, price_, choices_);
    density_.assign(field_.size(), 0);
    for (std::uint32_t const index : field_.visible()) {
        density_[index] = samples_per_pixel(choices_[index].level);
    }
    make_density_patches(field_.plane(), density_, field_.depth(), tiling_scratch_, cut_);
    rate_patches(field_, choices_, due_errors_, cut_, budget, rated_);
    double const most = std::max(input.rendered_per_second, input.samples_per_second) / input.samples_per_second;
    select_patches(samples, most * samples, rated_);
    if (!costs_.empty()) {
        mean_bits_ *= mean_cost(rated_, 0.2f);
    }
    auto const inspections = static_cast<std::ptrdiff_t>(cycle_.size());
    for (RatedPatch const& entry : rated_) {
        auto const end = cycle_.begin() + inspections;
        if (std::find(cycle_.begin(), end, entry.patch) == end) { // once is enough
            cycle_.push_back(entry.patch);
        }
    }
}

/// Where what the viewer holds shows the moment worst.
void AdaptiveRefresh::plan_moment(RefreshInput const& input, double samples, RefreshPlan& plan) {
    double const planned = input.samples_per_second * planned_seconds;
    if (!moments_.looks_at(input.moment->begun)) {
        plan.checks = moments_.look(plan.moment, input.moment->begun, planned,
                                    scene_moves_ ? input.limits.probe_share * planned : 0, plan.probes);
        samples -= visibility_cost * plan.checks->visibility.columns(plan.viewport) *
                       plan.checks->visibility.rows(plan.viewport) +
                   probe_cost * static_cast<double>(plan.probes.size());
    }
    find_costs(input);
    MomentBudget const budget{std::max(planned, samples), input.limits, costs_, input.moment->begun,
                              input.samples_per_second * plan_overhead};
    moments_.plan(field_, budget, rated_);
    double const most = std::max(input.rendered_per_second, input.samples_per_second) / input.samples_per_second;
    select_patches(samples, most * samples, rated_);
    if (!costs_.empty()) {
        mean_bits_ *= mean_cost(rated_, 0.2f);
    }
    for (RatedPatch const& entry : rated_) {
        cycle_.push_back(entry.patch);
    }
}

/// Of a moment that is not to be seen for long: a level finer where that shows most for its samples.
void AdaptiveRefresh::plan_refinement(double samples) {
    unresolved_.clear();
    for (std::uint32_t const index : field_.visible()) {
        Place const& place = field_[index];
        if (place.level < 0 || place.level + 1 >= sampling_levels || place.taken.level >= 0) {
            continue;
        }
        int const finer = place.level + 1;
        float const gain = unresolved_error(place.model, place.level) - unresolved_error(place.model, finer);
        if (gain > 0) {
            unresolved_.push_back({gain / samples_per_pixel(finer), index});
        }
    }
    std::ranges::sort(unresolved_, std::ranges::greater());
    auto const inspections = static_cast<std::ptrdiff_t>(cycle_.size());
    double planned = 0;
    for (auto const& [gain, index] : unresolved_) {
        Patch const patch{{(1u << (2 * field_.depth())) + index},
                          std::max(field_.depth_of(field_[index].level + 1), field_.depth())};
        auto const end = cycle_.begin() + inspections;
        if (std::find(cycle_.begin(), end, patch) != end) { // once is enough
            continue;
        }
        cycle_.push_back(patch);
        planned += tile_count(patch) * framelet_samples;
        if (planned >= samples) {
            return;
        }
    }
}

/// What stands still is finished in the end, whatever the model says of it.
void AdaptiveRefresh::plan_completion(double samples) {
    double tiles = 0;
    for (std::uint32_t const index : field_.visible()) {
        Place const& place = field_[index];
        bool const fine = place.level == sampling_levels - 1 && place.settled;
        bool const taken = place.taken.level == sampling_levels - 1 && place.taken.when >= still_since_;
        if (is_finest(index) || taken ||
            (scene_moves_ && fine)) { // while things move, probes and inspections are enough
            continue;
        }
        Patch const patch{{(1u << (2 * field_.depth())) + index}, field_.plane().max_depth()};
        cycle_.push_back(patch);
        tiles += tile_count(patch);
        if (tiles * framelet_samples >= samples) {
            return;
        }
    }
}

/// Where the finest samples of a still picture are not enough they are rendered once more, each with four rays: where
/// most is left unresolved first.
void AdaptiveRefresh::plan_supersampling(double samples) {
    unresolved_.clear();
    for (std::uint32_t const index : field_.visible()) {
        if (is_finest(index) && !is_finished(index) && field_[index].taken.level < 0) {
            unresolved_.push_back({field_[index].left, index});
        }
    }
    std::ranges::sort(unresolved_, std::ranges::greater());
    double rays = 0;
    for (auto const& [error, index] : unresolved_) {
        Patch const patch{{(1u << (2 * field_.depth())) + index}, field_.plane().max_depth()};
        cycle_.push_back(patch);
        rays_per_sample_ = four_rays;
        rays += tile_count(patch) * framelet_samples * four_rays;
        if (rays >= samples) {
            return;
        }
    }
}

/// Probes what seems to stand, the neighbours of what moves first.
void AdaptiveRefresh::plan_probes(double samples, RefreshPlan& plan) {
    active_.assign(field_.size(), 0);
    for (std::uint32_t const index : field_.visible()) {
        active_[index] = field_[index].model.motion > 0 ? 1 : 0;
    }
    auto const is_active = [this](int column, int row) {
        int const side = 1 << field_.depth();
        if (column < 0 || row < 0 || column >= side || row >= side) {
            return false;
        }
        return active_[morton_index(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row))] != 0;
    };
    auto const suspicion = [&](std::uint32_t index) {
        Place const& place = field_[index];
        int const column = static_cast<int>(morton_x(index));
        int const row = static_cast<int>(morton_y(index));
        bool beside = false;
        for (int y = row - 1; y <= row + 1; ++y) {
            for (int x = column - 1; x <= column + 1; ++x) {
                beside = beside || is_active(x, y);
            }
        }
        return (advanced_ - place.asked) * (beside ? 8 : 1);
    };
    suspects_.clear();
    std::vector<double>& keys = suspicions_;
    keys.assign(field_.size(), 0);
    for (std::uint32_t const index : field_.visible()) {
        Place const& place = field_[index];
        if (place.level < 0 || place.taken.level >= 0 || place.probe_count == 0) {
            continue;
        }
        // What is refreshed again and again needs no probes, as long as it is.
        bool const planned = place.model.motion > 0 && choices_.size() == field_.size() && choices_[index].recurring &&
                             static_cast<double>(choices_[index].period) < probe_period;
        double const expected = planned ? most_unseen : 0;
        keys[index] = suspicion(index);
        if (keys[index] > probe_period && advanced_ - place.asked > expected) {
            suspects_.push_back(index);
        }
    }
    auto const count = std::min(
        suspects_.size(), static_cast<std::size_t>(samples / (probe_cost * static_cast<double>(probes_per_place))));
    auto const middle = suspects_.begin() + static_cast<std::ptrdiff_t>(count);
    std::partial_sort(suspects_.begin(), middle, suspects_.end(), [&keys](std::uint32_t a, std::uint32_t b) {
        return keys[a] != keys[b] ? keys[a] > keys[b] : a < b;
    });
    for (auto at = suspects_.begin(); at != middle; ++at) {
        Place& place = field_[*at];
        place.asked = plan.now;
        plan.probed.push_back(*at);
        plan.probes.insert(plan.probes.end(), place.probes.begin(),
                           place.probes.begin() + static_cast<std::ptrdiff_t>(place.probe_count));
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
    if (plan.rays_per_sample != single_ray) {
        note_supersampled(plan);
        release(plan);
        send_.assign(framelets.size(), 1);
        return send_;
    }
    if (plan.checks && plan.checks->probe_spacing > 0) {
        moments_.note_looks(plan.moment, plan.probes, probe_luma, plan.checks->probe_spacing);
    }
    std::size_t probe = 0;
    for (std::uint32_t const index : plan.probed) {
        Place& place = field_[index];
        learn_probes(place, probe_luma.subspan(probe, place.probe_count), plan.now);
        probe += place.probe_count;
    }
    examine(plan, framelets, rendered);
    std::size_t first_tile = 0;
    std::size_t first_place = 0;
    for (std::size_t i = 0; i < plan.patches.size(); ++i) {
        auto const places = std::span(findings_).subspan(first_place, place_count(plan.patches[i]));
        bool const needed = learn_patch(field_, plan.patches[i], places, same_since_[i], plan.still_since, plan.now);
        auto const to = send_.begin() + static_cast<std::ptrdiff_t>(first_tile);
        std::fill(to, to + static_cast<std::ptrdiff_t>(plan.tile_counts[i]), needed ? 1 : 0);
        first_tile += plan.tile_counts[i];
        first_place += places.size();
    }
    release(plan);
    for (LumaHistory::Entry const& entry : entries_) {
        history_.store(entry);
    }
    if (plan.is_mirrored) { // it does not hold the same where it is needed, or this would not have been planned
        std::ranges::fill(send_, std::uint8_t{1});
    }
    return send_;
}

void AdaptiveRefresh::note_sent(RefreshPlan const& plan, std::uint64_t batch,
                                std::span<DisplayFramelet const> framelets, std::span<Framelet const> rendered,
                                std::span<std::uint8_t const> sent, std::span<FrameletShape> shapes) {
    if (plan.moment.motions != nullptr && plan.viewport == field_.plane().viewport()) {
        moments_.note_sent(plan.moment, batch, framelets, rendered, sent, shapes, plan.is_mirrored);
    }
}

void AdaptiveRefresh::note_visibility(RefreshPlan const& plan, std::span<float const> inverse_depth) {
    if (plan.viewport == field_.plane().viewport()) {
        moments_.note_visibility(plan.moment, plan.checks->visibility, inverse_depth);
    }
}

/// Nothing is learnt of the picture: compared with single rays it would seem to have changed.
void AdaptiveRefresh::note_supersampled(RefreshPlan const& plan) {
    for (Patch const& patch : plan.patches) {
        PlaceField::Range const range = field_.range_of(patch.node);
        for (std::uint32_t i = range.first; i < range.last; ++i) {
            Place& place = field_[i];
            place.drift = drift_since(place, plan.now);
            place.level = field_.level_of(patch.depth);
            place.rendered = place.checked = place.supersampled = plan.now;
        }
    }
}

/// What was taken by this plan, and not by a later one again, is no longer.
void AdaptiveRefresh::release(RefreshPlan const& plan) {
    for (Patch const& patch : plan.patches) {
        PlaceField::Range const range = field_.range_of(patch.node);
        for (std::uint32_t i = range.first; i < range.last; ++i) {
            if (field_[i].taken.when == plan.now) {
                field_[i].taken = {};
            }
        }
    }
}

std::size_t AdaptiveRefresh::place_count(Patch const& patch) const {
    PlaceField::Range const range = field_.range_of(patch.node);
    return range.last - range.first;
}

/// What the framelets say, of all patches in parallel.
void AdaptiveRefresh::examine(RefreshPlan const& plan, std::span<DisplayFramelet const> framelets,
                              std::span<Framelet const> rendered) {
    firsts_.clear();
    std::size_t tiles = 0;
    std::size_t places = 0;
    for (std::size_t i = 0; i < plan.patches.size(); ++i) {
        firsts_.push_back({tiles, places});
        tiles += plan.tile_counts[i];
        places += place_count(plan.patches[i]);
    }
    send_.resize(tiles);
    entries_.resize(tiles);
    findings_.resize(places);
    same_since_.resize(plan.patches.size());
    tbb::parallel_for(std::size_t{0}, plan.patches.size(), [&](std::size_t i) {
        Patch const& patch = plan.patches[i];
        auto const [tile, place] = firsts_[i];
        std::size_t const count = plan.tile_counts[i];
        auto const shows_motion = [](Framelet const& framelet) {
            return std::ranges::any_of(framelet.body, [](BodyNumber body) { return body != static_body; }) ||
                   std::ranges::any_of(framelet.velocity, [](Vec3 const& velocity) { return velocity != Vec3(0); });
        };
        double const same_since = examine_patch(field_, patch, framelets.subspan(tile, count),
                                                rendered.subspan(tile, count), {plan.now, plan.moment_begun},
                                                plan.moment, history_, std::span(entries_).subspan(tile, count),
                                                std::span(findings_).subspan(place, place_count(patch)));
        // The same picture may be of a body that has moved, and that the viewer has moved away.
        bool const moved =
            plan.moment.motions != nullptr && std::ranges::any_of(rendered.subspan(tile, count), shows_motion);
        same_since_[i] = moved ? never : same_since;
    });
}

} // namespace framelet
