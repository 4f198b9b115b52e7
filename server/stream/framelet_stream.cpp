#include "server/stream/framelet_stream.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "common/clock_state.h"
#include "common/error.h"
#include "common/framelet/reprojection.h"

namespace framelet {
namespace {

/// Seconds before a jump of the scene from when on moments are of what comes after it.
constexpr double awaited_seconds = 0.2;
/// Seconds by which a viewer's own camera is foreseen at most: nobody goes on as they do for long.
constexpr double most_forecast_seconds = 0.2;

/// What the scene's clock stands at so many seconds from now.
SceneTime time_in(double seconds, Turn const& turn) {
    return std::clamp(turn.present + turn.clock_speed * seconds, 0.0, max_scene_time);
}

} // namespace

FrameletStream::FrameletStream(StreamOptions const& options, std::uint32_t codings)
    : options_(options), codings_(codings) {
    viewer_.motions = BodyMotions(options_.knows_rest);
}

void FrameletStream::take(StreamEvent const& event) {
    if (auto const* const camera = std::get_if<CameraUpdate>(&event.what)) {
        if (!camera_ || camera->view.number > camera_->view.number) { // else a newer one is here already
            if (camera_ && camera->view.held_since != camera_->view.held_since) {
                forget_viewer();
            }
            camera_ = *camera;
            if (camera->scene_camera < 0) {
                forecast_.add(camera->view.camera, event.seconds);
            } else {
                forecast_.forget();
            }
        }
    } else if (auto const* const settings = std::get_if<ViewerSettings>(&event.what)) {
        settings_ = *settings;
    } else if (auto const* const ack = std::get_if<Ack>(&event.what)) {
        acknowledged_ = std::max(acknowledged_, ack->batch);
        std::optional<double> received;
        if (ack->received_us != 0) {
            received = 1e-6 * static_cast<double>(ack->received_us);
        }
        link_.acknowledged(ack->batch, event.seconds, received);
    } else if (auto const* const gone = std::get_if<Evicted>(&event.what)) {
        viewer_.refresh.forget(gone->framelets);
    } else if (auto const* const sent = std::get_if<BatchSent>(&event.what)) {
        link_.sent(sent->batch, event.seconds, static_cast<double>(sent->bytes));
    } else if (auto const* const resumed = std::get_if<Resumed>(&event.what)) {
        acknowledged_ = std::max(acknowledged_, resumed->last_batch);
        link_.restart(acknowledged_, static_cast<std::size_t>(viewer_.batches - acknowledged_));
        moments_.forget();
        complete_ = false;
    } else {
        moments_.note_clock_set();
    }
}

/// Forgets the viewer, which holds nothing and knows of nothing any more; its batches go on counting.
void FrameletStream::forget_viewer() {
    std::uint64_t const batches = viewer_.batches;
    viewer_ = {};
    viewer_.motions = BodyMotions(options_.knows_rest);
    viewer_.batches = batches;
    sums_.clear();
    complete_ = false;
    moments_.forget();
}

ViewState FrameletStream::state_at(SceneTime clock, PosedScene& scene) const {
    SceneTime const time = scene.is_animated() ? clock : 0;
    NumberedView view = camera_->view;
    int const scene_camera = camera_->scene_camera;
    if (scene_camera >= 0 && scene_camera < static_cast<int>(scene.scene().cameras.size())) {
        view.camera = scene.camera(scene_camera, time);
    }
    return {view, {options_.exposure * std::exp2(settings_.exposure_ev), options_.tone_curve}, time};
}

/// The scene's camera whose path the viewer has to know; -1: none.
int FrameletStream::moving_camera(PosedScene const& scene) const {
    return takes_shapes() && scene.camera_moves(camera_->scene_camera) ? camera_->scene_camera : -1;
}

bool FrameletStream::has_room(double now) const {
    std::uint64_t const unlearnt = planned_ != nullptr ? 1 : 0;
    return viewer_.batches + unlearnt - acknowledged_ < max_batches_in_flight && link_.has_room(now);
}

Step FrameletStream::plan(Turn const& turn, PosedScene& scene) {
    if (!camera_) {
        return Step::nothing;
    }
    if (settings_.paused) {
        complete_ = false; // what it would see by now is not known
        return planned_ != nullptr ? Step::finish : Step::nothing;
    }
    ViewState const present = state_at(turn.present, scene);
    if (viewer_.refresh.is_complete(present)) {
        if (planned_ != nullptr) {
            return Step::finish;
        }
        complete_ = !viewer_.refresh.held_tiles().any_lossy();
        if (complete_) {
            sums_.clear();
            viewer_.refresh.settle();
            return Step::nothing;
        }
        if (!has_room(turn.now)) {
            return Step::wait;
        }
        plan_exactly(present, turn.now, scene);
        return Step::render;
    }
    return has_room(turn.now) ? plan_batch(turn, present, scene) : Step::wait;
}

/// What of the scene jumps within so many seconds from now, where it is to be prepared for.
Switches FrameletStream::switches_ahead(Turn const& turn, PosedScene const& scene, double seconds) const {
    if (!options_.awaits_switches || !(turn.clock_speed > 0)) {
        return {};
    }
    double const ahead = seconds * turn.clock_speed;
    return switches_within(scene.switches(), turn.present, std::min(turn.present + ahead, max_scene_time));
}

/// The viewer's camera so many seconds from now, if it goes on as it does.
Camera FrameletStream::camera_in(double seconds, Turn const& turn, PosedScene& scene) const {
    return camera_->scene_camera < 0 ? forecast_.at(turn.now, std::min(seconds, most_forecast_seconds))
                                     : state_at(time_in(seconds, turn), scene).view.camera;
}

/// How long a moment that begins now lasts, seconds: not long where only some of the picture is to be replaced, nor
/// where it would still be shown when the scene jumps.
double FrameletStream::new_moment_seconds(bool camera_moves, Turn const& turn, PosedScene const& scene) const {
    if (options_.moment_seconds) {
        return *options_.moment_seconds;
    }
    Viewport const viewport = camera_->view.viewport;
    double const pixels = static_cast<double>(viewport.width) * viewport.height;
    double const usual = camera_moves ? moment_seconds(samples_per_second(turn) / pixels) : moments_.standing_seconds();
    double seconds = worth_posing(usual, turn.pose_seconds);
    auto const jumps = [&] { return switches_ahead(turn, scene, awaited_seconds + seconds).any; };
    while (seconds > usual && jumps()) {
        seconds = std::max(0.5 * seconds, usual);
    }
    return jumps() ? std::min(usual, least_moment_seconds) : seconds;
}

/// Seconds by which a moment's camera is ahead of the moment: what the first batch of the next one takes until it is
/// shown, since till then what newly comes into view has to be there. A camera of the scene has no lead unless it
/// turns, when much comes into view; as it is known where that goes, it is given the time, too, that a picture takes
/// the viewer, which is about as long again. `now`, `then`: the camera at present and after the least moment's length.
double FrameletStream::camera_lead(Camera const& now, Camera const& then, Turn const& turn,
                                   PosedScene const& scene) const {
    constexpr double least_turn = 0.02; // radians within the least moment's length
    if (!options_.camera_leads) {
        return 0;
    }
    double const batch_seconds = 0.5 * cycle_length(false, turn.plan_seconds);
    double const lead = turn.plan_seconds + batch_seconds + link_.state().delivery_seconds;
    if (camera_->scene_camera < 0) {
        return std::min(lead, least_moment_seconds);
    }
    bool const turns =
        static_cast<double>(glm::length(glm::cross(now.forward(), then.forward()))) > std::sin(least_turn);
    bool const jumps = switches_ahead(turn, scene, awaited_seconds + least_moment_seconds).any;
    return turns && !jumps ? std::min(2 * lead, least_moment_seconds) : 0;
}

/// Seconds that samples travel before they show, where that is as long as a moment: what is less is not worth to look
/// further ahead.
double FrameletStream::travel_seconds() const {
    constexpr double least = 0.06;
    double const delivery = link_.state().delivery_seconds;
    return delivery > least ? delivery : 0;
}

/// A moment is of what is to be seen later, if the scene's clock and the viewer's camera go on as they do: of when it
/// ends or, where all of the picture is replaced, of the middle of the time that it is shown, since its samples come
/// while it lasts and show until those of the next moment have come. Where the scene is about to jump, the moment is of
/// what comes after that, which shares nothing with what is held, and waits with the viewer.
HeldMoment FrameletStream::new_moment(Turn const& turn, PosedScene& scene) const {
    Camera const now = camera_in(0, turn, scene);
    Camera const then = camera_in(least_moment_seconds, turn, scene);
    if (!moves_samples_) { // what comes shows at once, as it is, until something else comes
        double const seconds = worth_posing(0.5 * moments_.standing_seconds(), turn.pose_seconds);
        double const ahead = options_.looks_ahead ? seconds : 0;
        return {state_at(time_in(ahead, turn), scene), turn.now, seconds, 0, false};
    }
    bool const camera_moves = then != now;
    double const seconds = new_moment_seconds(camera_moves, turn, scene);
    double scene_ahead = options_.looks_ahead ? (camera_moves ? 1.5 : 1) * seconds + travel_seconds() : 0;
    double camera_ahead = scene_ahead + camera_lead(now, then, turn, scene);
    auto const jump = switches_ahead(turn, scene, awaited_seconds).lone;
    if (jump) {
        constexpr SceneTime just_after = 1e-4; // more than rounding
        scene_ahead = camera_ahead = (jump->time + jump->settling + just_after - turn.present) / turn.clock_speed;
    }
    ViewState state = state_at(time_in(scene_ahead, turn), scene);
    state.view.camera = camera_in(camera_ahead, turn, scene);
    return {state, turn.now, seconds, jump ? jump->time : 0, jump && jump->is_seen};
}

/// Samples a second that renderer and link have time for.
double FrameletStream::samples_per_second(Turn const& turn) const {
    return options_.follows_link ? bounded_rate(link_.state(), turn.samples_per_second) : turn.samples_per_second;
}

std::optional<HeldMoment> FrameletStream::moment_at(Turn const& turn, ViewState const& present, PosedScene& scene) {
    if (moments_.observe(present, turn.now)) {
        moments_.begin(new_moment(turn, scene));
        if (moments_.held()->outdates) {
            viewer_.motions.jump_at(moments_.held()->shown_from);
        }
    }
    return moments_.held();
}

Step FrameletStream::plan_batch(Turn const& turn, ViewState const& present, PosedScene& scene) {
    LinkState const link = link_.state();
    double const rendered = turn.samples_per_second;
    rendered_per_second_ = std::max(rendered, 1.0);
    moves_samples_ = takes_shapes() && is_reprojectable(present.view.camera);
    RefreshInput wanted;
    wanted.state = present;
    wanted.moment = moment_at(turn, present, scene);
    bool const still = !wanted.moment && viewer_.refresh.is_still(present);
    wanted.now = turn.now;
    wanted.samples_per_second = samples_per_second(turn);
    wanted.rendered_per_second = options_.prices_bytes ? rendered : wanted.samples_per_second;
    wanted.cycle_seconds = cycle_length(still, turn.plan_seconds);
    if (options_.follows_link) { // half a cycle is a batch
        wanted.cycle_seconds = std::max(wanted.cycle_seconds, static_cast<float>(2 * worthwhile_seconds(link)));
    }
    wanted.bias = std::clamp(static_cast<float>(options_.bias) + settings_.bias, -1.0f, 1.0f);
    wanted.batch_framelets = options_.batch_framelets;
    wanted.link_framelets = options_.follows_link ? bounded_batch(link) : max_batch_framelets;
    wanted.motions = &viewer_.motions;
    wanted.moves_samples = takes_shapes();
    wanted.light_changes = scene.light_gathering() != nullptr && scene.light_gathering()->is_learning();
    wanted.limits = options_.limits;
    if (scene.path_light() != nullptr) {
        wanted.completion = completion_of_paths;
        wanted.least_framelets = scene.light_gathering() == nullptr ? turn.busy_framelets : 1;
        wanted.limits.most_level = std::min(wanted.limits.most_level, completion_of_paths.finest);
        wanted.limits.most_rays = single_ray;
    }
    if (!still) {
        sums_.clear();
    }
    BatchWork& work = free_work();
    BatchOrder& order = work.order;
    order.state = wanted.moment ? wanted.moment->state : present;
    order.present = present;
    order.scene_camera = moving_camera(scene);
    order.shown_from = wanted.moment ? wanted.moment->shown_from : 0;
    order.outdates = wanted.moment && wanted.moment->outdates;
    order.qp = takes_loss() ? choice_.choose(link, sent_share_.value() * rendered, turn.now) : lossless_qp;
    order.takes_shapes = wanted.moment ? moves_samples_ : takes_shapes(); // at rest for clicks
    order.skips = options_.skips;
    order.last_depth = still ? viewer_.refresh.regions().depth_of(wanted.completion.finest) : -1;
    order.again = false;
    viewer_.refresh.plan(wanted, order.plan);
    if (order.plan.is_empty()) { // once what is rendered is learnt there may be something
        if (planned_ != nullptr) {
            return Step::finish;
        }
        if (wanted.moment) {
            moments_.note_complete(turn.now);
            return Step::wait;
        }
        return Step::nothing; // at rest there will be more to do
    }
    set_planned(work);
    work.figures.is_new_cycle = order.plan.is_new_cycle;
    work.figures.regions = viewer_.refresh.regions().visible().size();
    return Step::render;
}

/// Plans some of what the viewer was sent with loss once more, exactly: but for that the picture is complete. What has
/// four rays a sample is not among it: it was sent exactly, since nothing moved.
void FrameletStream::plan_exactly(ViewState const& present, double now, PosedScene const& scene) {
    constexpr std::size_t most_framelets = 1024;
    BatchWork& work = free_work();
    work.order = {present, present, moving_camera(scene), 0, false, {}, lossless_qp, takes_shapes(), true, -1, true};
    work.order.plan.moment_begun = now;
    viewer_.refresh.held_tiles().list_lossy(std::min(bounded_batch(link_.state()), most_framelets),
                                            work.order.plan.tiles);
    set_planned(work);
}

/// The work that is neither still to be learnt nor may be encoded at the moment.
BatchWork& FrameletStream::free_work() {
    BatchWork const* const used = planned_ != nullptr ? planned_ : learnt_;
    return works_[used == works_.data() ? 1 : 0];
}

/// Makes a work, whose order is complete, the one that was planned last.
void FrameletStream::set_planned(BatchWork& work) {
    work.figures = {};
    work.figures.framelets = work.order.plan.tiles.size();
    work.figures.rays = work.order.plan.ray_count();
    work.figures.probes = work.order.plan.probes.size();
    earlier_ = planned_;
    planned_ = &work;
}

void FrameletStream::render(PosedScene const& scene) {
    FRAMELET_CHECK(planned_ != nullptr);
    planned_->render(scene, sums_, options_.workers);
}

bool FrameletStream::learn(PosedScene& scene) {
    learnt_ = earlier_ != nullptr ? std::exchange(earlier_, nullptr) : std::exchange(planned_, nullptr);
    FRAMELET_CHECK(learnt_ != nullptr);
    if (learnt_->order.state.view.held_since != camera_->view.held_since) {
        complete_ = false;
        return false; // the viewer would not take it
    }
    bool const sends = learnt_->learn(scene, viewer_);
    auto const samples = sends ? static_cast<double>(learnt_->batch().framelets.size() * framelet_samples) : 0.0;
    if (sends) {
        link_.begin(samples);
    }
    TurnFigures const& figures = learnt_->figures;
    sent_share_.add(static_cast<double>(figures.rays) + probe_cost * static_cast<double>(figures.probes), samples,
                    rendered_per_second_);
    complete_ = !viewer_.refresh.held_tiles().any_lossy() && viewer_.refresh.is_complete(learnt_->order.present);
    return sends;
}

EncodedBatch FrameletStream::encode() {
    return learnt_->encode(codec_, memory_, takes_predictions());
}

} // namespace framelet
