#include "server/session/session_loop.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include <tbb/global_control.h>
#include <tbb/task_group.h>

#include "server/session/contained.h"
#include "server/session/laps.h"

namespace framelet {
namespace {

/// Samples a second of a renderer that has not been measured yet.
constexpr double first_rate = 1e6;
/// From so many threads on learning overlaps rendering. Its serial part would leave most of them idle; few are busy
/// with its parallel part, which is cheaper while what was rendered is still in the caches.
constexpr std::size_t many_threads = 5;

std::size_t thread_count() {
    return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

} // namespace

/// The batch that was rendered last is finished while the next one renders.
struct SessionLoop::Pipeline {
    std::array<BatchWork, 2> works;
    BatchWork* rendered = nullptr; ///< and not finished; null: none
    bool learnt = false; ///< that one is
    BatchCodec codec;
    tbb::task_group finishing;

    BatchWork& free_work() { return works[rendered == works.data() ? 1 : 0]; }
    bool is_of(ViewerState const& viewer) const { return rendered != nullptr && rendered->order.viewer == &viewer; }
    bool is_unlearnt() const { return rendered != nullptr && !learnt; }
};

SessionLoop::SessionLoop(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene,
                         SceneClock const& clock, LoopOptions options, Events events)
    : scene_(scene), clips_(std::move(clips)), animated_(animation_duration(scene, clips_) > 0),
      render_scene_(render_scene), clock_(clock), options_(options), events_(std::move(events)),
      pose_(evaluate_pose(scene, clips_, 0)), pipeline_(std::make_unique<Pipeline>()) {
    render_scene_.set_clips(clips_);
    render_scene_.set_pose(pose_);
}

SessionLoop::~SessionLoop() {
    pipeline_->finishing.wait();
}

void SessionLoop::run() {
    for (;;) {
        {
            std::unique_lock lock(mutex_);
            if (stop_) {
                return;
            }
            wake_ = false;
        }
        Sessions const sessions = events_.open_sessions();
        bool const rendered = cycle(sessions, std::chrono::steady_clock::now());
        if (rendered || finish_rendered()) {
            continue;
        }
        // Nothing to do until a viewer or the clock says so. While the clock runs every display frame is worth a look.
        bool const playing = animated_ && clock_.state(std::chrono::steady_clock::now()).playing && !sessions.empty();
        std::unique_lock lock(mutex_);
        auto const woken = [this] { return wake_ || stop_; };
        if (playing || waits_for_room_) { // the link's time passes without a word from it
            woken_.wait_for(lock, std::chrono::milliseconds(5), woken);
        } else {
            woken_.wait(lock, woken);
        }
    }
}

bool SessionLoop::cycle(Sessions const& sessions, WallTime now) {
    forget_ended(sessions);
    if (sessions.empty()) {
        return false;
    }
    SceneTime const time = animated_ ? clock_.state(now).time : 0;
    pose_scene(time);
    waits_for_room_ = false;
    double const share = 1 / static_cast<double>(sessions.size());
    bool rendered = false;
    for (auto const& session : sessions) {
        bool const served =
            contain(*session, [&] { rendered |= render_session(*session, viewers_[session->id()], time, share); });
        if (!served) {
            drop_rendered(*session);
        }
    }
    return rendered;
}

bool SessionLoop::render_session(Session& session, ViewerState& viewer, SceneTime time, double share) {
    AdaptiveRefresh& refresh = viewer.refresh;
    SessionInput const input = session.newest_input();
    if (!input.camera) {
        return false;
    }
    ViewState const state{resolve_camera(*input.camera), options_.exposure * std::exp2(input.settings.exposure_ev),
                          time};
    if (refresh.is_complete(state)) {
        if (pipeline_->is_of(viewer) && finish_rendered()) {
            return true;
        }
        if (!viewer.lossy.empty()) {
            return send_exactly(session, viewer, input, state);
        }
        if (session.report(input.version, true)) {
            events_.convergence_changed();
        }
        return false;
    }
    bool const unsent = pipeline_->is_unlearnt() && pipeline_->is_of(viewer);
    if (!session.has_room(unsent ? 1 : 0)) {
        waits_for_room_ = true;
        return finish_rendered();
    }
    Laps laps;
    BatchWork& work = pipeline_->free_work();
    work.record = {};
    plan(session, viewer, input, state, share, work.order);
    if (work.order.plan.is_empty()) {
        return finish_rendered(); // once that is learnt there may be something
    }
    work.record.stage_seconds.plan = laps.lap();
    if (work.order.plan.is_new_cycle) {
        constexpr double weight = 0.1;
        plan_seconds_ += weight * (work.record.stage_seconds.plan - plan_seconds_);
    }
    if (options_.recorder != nullptr) {
        work.record.session = session.id();
        work.record.scene_time = time;
        work.record.samples_rendered = work.order.plan.ray_count();
        work.record.probes = work.order.plan.probes.size();
        describe(refresh, work.record);
        laps.lap();
    }
    if (pipeline_->is_unlearnt()) {
        start_finishing();
    }
    work.render(shared());
    work.record.stage_seconds.render = laps.lap();
    wait_for_finishing();
    work.record.stage_seconds.wait = laps.lap();
    pipeline_->rendered = &work;
    pipeline_->learnt = false;
    if (thread_count() < many_threads) {
        work.learn(shared());
        pipeline_->learnt = true;
        start_finishing();
    }
    double const learning = laps.lap(); // by itself

    if (!work.order.plan.tiles.empty()) {
        // Planning left out: it takes as long for few samples, which would then seem to be dear.
        double const samples = static_cast<double>(work.order.plan.ray_count());
        rate_ = update_render_rate(rate_, samples,
                                   work.record.stage_seconds.render + work.record.stage_seconds.wait + learning);
        samples_per_second_ = rate_.samples_per_second;
    }
    return true;
}

void SessionLoop::plan(Session& session, ViewerState& viewer, SessionInput const& input, ViewState const& state,
                       double share, BatchOrder& order) {
    RefreshInput wanted;
    wanted.state = state;
    wanted.now = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    LinkState const link = session.link();
    double const rendered = share * (rate_.samples_per_second > 0 ? rate_.samples_per_second : first_rate);
    std::uint8_t const quality = input.takes_loss() ? viewer.choice.choose(link, rendered, wanted.now) : exact_quality;
    bool const still = viewer.refresh.is_still(state);
    wanted.samples_per_second = bounded_rate(link, rendered);
    wanted.rendered_per_second = rendered;
    wanted.cycle_seconds = cycle_length(still, plan_seconds_);
    wanted.delivery_seconds = static_cast<float>(link.delivery_seconds);
    wanted.bias = std::clamp(static_cast<float>(options_.bias) + input.settings.bias, -1.0f, 1.0f);
    wanted.batch_framelets = options_.batch_framelets;
    wanted.link_framelets = bounded_batch(link);
    wanted.motions = input.takes_shapes() ? &viewer.motions : nullptr;
    order.session = session.shared_from_this();
    order.viewer = &viewer;
    order.input = input;
    order.state = state;
    order.quality = quality;
    order.still = still;
    order.again = false;
    viewer.refresh.plan(wanted, order.plan);
}

/// The picture is complete, but for what the viewer was sent with loss: some of that once more. What has four rays a
/// sample is not among it: it was sent exactly, since nothing moved.
bool SessionLoop::send_exactly(Session& session, ViewerState& viewer, SessionInput const& input,
                               ViewState const& state) {
    if (!session.has_room(0)) {
        waits_for_room_ = true;
        return false;
    }
    constexpr std::size_t most_framelets = 1024;
    finish_rendered();
    BatchWork& work = pipeline_->free_work();
    work.order = {session.shared_from_this(), &viewer, input, state, {}, exact_quality, true, true};
    viewer.lossy.list(std::min(bounded_batch(session.link()), most_framelets), work.order.plan.tiles);
    work.render(shared());
    pipeline_->rendered = &work;
    pipeline_->learnt = false;
    return finish_rendered();
}

void SessionLoop::start_finishing() {
    // It counts as learnt from here on: whatever fails meanwhile, it is not begun a second time.
    auto const finish = [this, learnt = std::exchange(pipeline_->learnt, true)] {
        BatchWork& work = *pipeline_->rendered;
        contain(*work.order.session, [&] {
            if (!learnt && work.order.session->is_open()) {
                work.learn(shared());
            }
            if (work.order.session->is_open() && work.send(pipeline_->codec)) {
                events_.convergence_changed();
            }
        });
    };
    // With one thread it would not begin before the next batch is rendered, and be late by that.
    if (thread_count() > 1) {
        pipeline_->finishing.run(finish);
    } else {
        finish();
    }
}

void SessionLoop::wait_for_finishing() {
    pipeline_->finishing.wait();
    BatchWork* const done = std::exchange(pipeline_->rendered, nullptr);
    if (done == nullptr) {
        return;
    }
    if (options_.recorder != nullptr && !done->order.again) {
        contain(*done->order.session, [&] {
            options_.recorder->add(done->record, done->order.viewer->refresh, done->order.plan.now);
        });
    }
    done->order.session.reset();
}

/// What failed is not tried again when it is to be finished.
void SessionLoop::drop_rendered(Session const& session) {
    if (pipeline_->rendered != nullptr && pipeline_->rendered->order.session.get() == &session) {
        pipeline_->finishing.wait();
        pipeline_->rendered->order.session.reset();
        pipeline_->rendered = nullptr;
    }
}

bool SessionLoop::finish_rendered() {
    bool const learns = pipeline_->is_unlearnt();
    if (learns) {
        start_finishing();
    }
    wait_for_finishing();
    return learns;
}

void SessionLoop::pose_scene(SceneTime time) {
    if (time != pose_.time) {
        pose_ = evaluate_pose(scene_, clips_, time);
        render_scene_.set_pose(pose_);
    }
}

NumberedView SessionLoop::resolve_camera(CameraUpdate const& camera) const {
    NumberedView view = camera.view;
    if (camera.scene_camera >= 0 && camera.scene_camera < static_cast<int>(scene_.cameras.size())) {
        view.camera = framelet::scene_camera(scene_, pose_, camera.scene_camera);
    }
    return view;
}

void SessionLoop::forget_ended(Sessions const& sessions) {
    auto const has_ended = [&sessions](auto const& entry) {
        return std::none_of(sessions.begin(), sessions.end(),
                            [&entry](auto const& session) { return session->id() == entry.first; });
    };
    if (std::any_of(viewers_.begin(), viewers_.end(), has_ended)) {
        finish_rendered(); // it may be of one of them
        std::erase_if(viewers_, has_ended);
    }
}

void SessionLoop::wake() {
    {
        std::scoped_lock const lock(mutex_);
        wake_ = true;
    }
    woken_.notify_one();
}

void SessionLoop::stop() {
    {
        std::scoped_lock const lock(mutex_);
        stop_ = true;
    }
    woken_.notify_one();
}

} // namespace framelet
