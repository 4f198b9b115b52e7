#include "server/session/loop/session_loop.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <stdexcept>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>
#include <tbb/global_control.h>
#include <tbb/task_group.h>

#include "common/laps.h"
#include "server/session/limits/wall_time.h"
#include "server/session/loop/contained.h"
#include "server/stream/event_log.h"

namespace framelet {
namespace {

/// Threads from which on learning overlaps rendering. Its serial part would leave most of them idle; few are busy with
/// its parallel part, which is cheaper while what was rendered is still in the caches.
constexpr std::size_t many_threads = 5;
/// A viewer that took nothing in its turns for so long leaves its share of the time to the others.
constexpr std::chrono::milliseconds sharing_time{250};
constexpr std::chrono::milliseconds short_pause{5};
/// Time between two attempts to build a scene for which memory was missing, while nobody has a turn.
constexpr std::chrono::seconds scene_pause{1};

std::size_t thread_count() {
    return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

} // namespace

struct SessionLoop::Viewer {
    std::shared_ptr<Session> session; ///< the newest
    std::uint64_t number = 0; ///< as `Session::number` of its first session
    std::unique_ptr<ViewerStream> stream;
    std::vector<StreamEvent> events; ///< scratch
    /// When something was rendered for it last; nothing: it needs no share of the time.
    std::optional<WallTime> rendered;
};

/// The batch that was rendered last is finished while the next one renders.
struct SessionLoop::Pipeline {
    struct Rendered {
        std::shared_ptr<Session> session;
        Viewer* viewer = nullptr;
        std::uint64_t version = 0; ///< that it was planned for
        bool learnt = false;
        bool sends = false; ///< once it is learnt
        bool complete = false; ///< likewise: with it the viewer's picture is complete
    };
    std::optional<Rendered> rendered; ///< the batch that was rendered last, until it is finished
    tbb::task_group finishing;

    bool is_unlearnt() const { return rendered && !rendered->learnt; }
};

SessionLoop::SessionLoop(PosedScene& scene, SceneClock const& clock, LoopOptions options, Events events)
    : scene_(scene), clock_(clock), options_(std::move(options)), events_(std::move(events)),
      pipeline_(std::make_unique<Pipeline>()) {}

SessionLoop::~SessionLoop() {
    pipeline_->finishing.wait();
}

void SessionLoop::run() {
    for (;;) {
        {
            std::unique_lock lock(mutex_);
            if (stop_) {
                break;
            }
            wake_ = false;
        }
        try {
            serve_once();
        } catch (std::exception const&) { // it was for none of the sessions, which are all served later
            std::this_thread::sleep_for(short_pause);
        }
    }
    pipeline_->finishing.wait(); // it tells the sessions' events, which may wake this loop
}

/// Gives each viewer a turn, and waits where there was nothing to do in them.
void SessionLoop::serve_once() {
    Sessions const sessions = events_.open_sessions();
    WallTime const began = std::chrono::steady_clock::now();
    bool const worked = give_turns(sessions, began) || finish_rendered();
    busy_seconds_ = busy_seconds_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    if (worked || (has_scene_ && learn_light())) {
        return;
    }
    if (!has_scene_) {
        try_for_scene(began);
    }
    // Nothing to do until a viewer or the clock says so. While the clock runs every display frame is worth a look.
    bool const playing =
        scene_.is_animated() && clock_.state(std::chrono::steady_clock::now()).playing && !sessions.empty();
    std::unique_lock lock(mutex_);
    auto const woken = [this] { return wake_ || stop_; };
    if (playing || waits_for_room_) { // the link's time passes without a word from it
        woken_.wait_for(lock, short_pause, woken);
    } else if (!has_scene_) {
        woken_.wait_for(lock, scene_pause, woken);
    } else {
        woken_.wait(lock, woken);
    }
}

/// Learns light while no viewer waits for anything; false where all that matters is known.
bool SessionLoop::learn_light() {
    bool const learns = scene_.learn_light(options_.stream.workers);
    if (!learns && scene_.light_gathering() != nullptr && !std::exchange(has_learnt_light_, true)) {
        spdlog::info("the light of the scene is learnt");
    }
    return learns;
}

/// Poses the scene, and notes whether there was memory for that. False where it was posed so.
bool SessionLoop::pose_scene(SceneTime time) {
    bool has_moved = false;
    try {
        has_moved = scene_.pose(time);
    } catch (SceneUnposed const& failure) {
        if (has_scene_.exchange(false)) {
            spdlog::warn("{}; it is built again as soon as there is enough", failure.what());
        }
        throw;
    }
    if (!has_scene_.exchange(true)) {
        spdlog::info("the scene has been built again");
    }
    return has_moved;
}

/// Tries to build the scene again though nobody has a turn: nobody may come to a server that says it is not well.
void SessionLoop::try_for_scene(WallTime now) {
    if (now - tried_for_scene_ < scene_pause) {
        return;
    }
    tried_for_scene_ = now;
    try {
        pose_scene(scene_.is_animated() ? clock_.state(now).time : 0);
    } catch (SceneUnposed const&) { // later
    }
}

/// Gives each viewer one turn; true when something was rendered or learnt.
bool SessionLoop::give_turns(Sessions const& sessions, WallTime now) {
    forget_ended();
    waits_for_room_ = false;
    bool worked = false;
    for (auto const& session : sessions) {
        if (!session->is_ready()) {
            continue;
        }
        bool const served = contain(*session, [&] { worked |= give_turn(session, viewer_of(session), now); });
        if (!served) {
            drop_rendered(*session);
        }
    }
    rate_ = update_render_rate(rate_, round_.samples, round_.seconds);
    round_ = {};
    samples_per_second_ = rate_.samples_per_second;
    return worked;
}

/// Number of viewers among whom the time is shared when it is this one's turn: those that can take none at present,
/// because they have all or read nothing, do not count.
std::size_t SessionLoop::sharers(Viewer const& served) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        viewers_, [&served](auto const& entry) { return entry.second.get() == &served || entry.second->rendered; }));
}

SessionLoop::Viewer& SessionLoop::viewer_of(std::shared_ptr<Session> const& session) {
    auto found = viewers_.find(session->id());
    if (found == viewers_.end()) {
        std::shared_ptr<Session> const earlier = session->earlier();
        auto viewer = earlier ? take_up(*session, earlier) : new_viewer(session);
        viewer->session = session;
        found = viewers_.emplace(session->id(), std::move(viewer)).first;
    }
    return *found->second;
}

std::unique_ptr<SessionLoop::Viewer> SessionLoop::new_viewer(std::shared_ptr<Session> const& session) const {
    std::uint32_t const codings = session->codings();
    auto viewer = std::make_unique<Viewer>();
    viewer->session = session;
    viewer->number = session->number();
    viewer->stream = options_.make_stream ? options_.make_stream(options_.stream, codings)
                                          : std::make_unique<FrameletStream>(options_.stream, codings);
    if (options_.event_log != nullptr) {
        options_.event_log->add_viewer(viewer->number, codings);
    }
    return viewer;
}

/// Takes what is known of the viewer from the session that this one resumes.
std::unique_ptr<SessionLoop::Viewer> SessionLoop::take_up(Session& session, std::shared_ptr<Session> const& earlier) {
    finish_rendered(); // it may be of that one
    if (!session.take_over(*earlier)) {
        throw std::runtime_error("there was no memory left for it while the viewer was away");
    }
    auto const found = viewers_.find(earlier->id());
    if (found == viewers_.end()) {
        return new_viewer(earlier);
    }
    std::unique_ptr<Viewer> viewer = std::move(found->second);
    viewers_.erase(found);
    return viewer;
}

bool SessionLoop::give_turn(std::shared_ptr<Session> const& session, Viewer& viewer, WallTime round_began) {
    ViewerStream& stream = *viewer.stream;
    std::uint64_t const version = session->take_events(viewer.events);
    // Asks for the time after the events are taken: else a picture that is complete for the time that was could be
    // reported as complete for one that was set meanwhile.
    ClockState const clock = clock_.state(round_began);
    double const rate = rate_.samples_per_second > 0 ? rate_.samples_per_second : first_samples_per_second;
    double const speed = clock.playing ? double{clock.speed} : 0;
    WallTime const now = std::chrono::steady_clock::now();
    auto const among = static_cast<double>(sharers(viewer)); // a cycle is as long as all their planning asks for
    WorkerPool const* const workers = options_.stream.workers;
    Turn const turn{seconds_of(now),
                    clock.time,
                    speed,
                    rate / among,
                    among * plan_seconds_,
                    among * pose_seconds_,
                    workers != nullptr ? workers->chunks_at_once() : 1};
    EventLog* const log = options_.event_log;
    for (StreamEvent const& event : viewer.events) {
        stream.take(event);
        if (log != nullptr) {
            log->add_event(viewer.number, event);
        }
    }
    Laps laps;
    Step const step = stream.plan(turn, scene_);
    if (log != nullptr) {
        log->add_turn(viewer.number, turn, step);
    }
    if (step != Step::render) {
        if (viewer.rendered && now - *viewer.rendered >= sharing_time) {
            viewer.rendered.reset();
        }
        waits_for_room_ = waits_for_room_ || step == Step::wait;
        if (finish_rendered()) {
            return true;
        }
        if (step == Step::nothing && stream.is_complete() && session->report(version, true)) {
            events_.convergence_changed();
        }
        return false;
    }
    viewer.rendered = now;
    double const planning = laps.lap();
    TurnFigures const figures = stream.planned_figures();
    if (figures.is_new_cycle) {
        constexpr double weight = 0.1;
        plan_seconds_ += weight * (planning - plan_seconds_);
    }
    bool const begins = pose_scene(stream.moment());
    double const posing = laps.lap();
    if (pipeline_->is_unlearnt()) {
        start_finishing();
    }
    stream.render(scene_);
    wait_for_finishing();
    double const rendering = laps.lap(); // until the batch before was encoded and sent
    pipeline_->rendered = {session, &viewer, version};
    if (thread_count() < many_threads) {
        finish_one(true);
        start_finishing();
    }
    double const learning = laps.lap(); // by itself
    note_rate(figures, rendering + learning, begins ? std::optional(posing) : std::nullopt);
    return true;
}

/// Notes how long rendering took, with planning left out: that takes as long for few samples, which would then seem to
/// be dear. So would those of one viewer's small batch that was interrupted: what a round rendered counts together. So
/// would the first ones of a moment, of which `posing`, seconds, was a part, and bodies by the thousand are told with
/// them: they count as at most twice as dear as others.
void SessionLoop::note_rate(TurnFigures const& figures, double seconds, std::optional<double> posing) {
    constexpr double weight = 0.2, most_of_first = 2;
    auto const rays = static_cast<double>(figures.rays);
    rays_ = rays_ + rays;
    if (posing) {
        seconds += *posing;
        double const usual = rate_.samples_per_second > 0 ? rays / rate_.samples_per_second : seconds;
        pose_seconds_ += weight * (std::max(seconds - usual, *posing) - pose_seconds_);
        seconds = std::min(seconds, most_of_first * usual);
    }
    if (rays > 0) {
        round_.samples += rays;
        round_.seconds += seconds;
    }
}

/// Learns what was rendered, or encodes and sends what was learnt.
void SessionLoop::finish_one(bool learns) {
    Pipeline::Rendered& done = *pipeline_->rendered;
    ViewerStream& stream = *done.viewer->stream;
    EventLog* const log = options_.event_log;
    if (learns) {
        done.sends = stream.learn(scene_);
        done.learnt = true;
        done.complete = stream.is_complete();
        if (log != nullptr) {
            log->add_learning(done.viewer->number);
        }
        return;
    }
    if (done.sends) {
        EncodedBatch batch = stream.encode();
        if (log != nullptr) {
            log->add_batch(done.viewer->number, batch);
        }
        done.session->send_batch(std::move(batch));
    }
    if (done.session->report(done.version, done.complete)) {
        events_.convergence_changed();
    }
}

void SessionLoop::start_finishing() {
    // It counts as learnt from here on: whatever fails meanwhile, it is not begun a second time.
    auto const finish = [this, learnt = std::exchange(pipeline_->rendered->learnt, true)] {
        Session& session = *pipeline_->rendered->session;
        contain(session, [&] {
            if (!learnt && session.is_served()) {
                finish_one(true);
            }
            if (session.is_served()) {
                finish_one(false);
            }
        });
    };
    // With one thread finishing would not begin before the next batch is rendered, and be late by that.
    if (thread_count() > 1) {
        pipeline_->finishing.run(finish);
    } else {
        finish();
    }
}

void SessionLoop::wait_for_finishing() {
    pipeline_->finishing.wait();
    pipeline_->rendered.reset();
}

/// Drops what was rendered for a session that failed, so that finishing it is not tried.
void SessionLoop::drop_rendered(Session const& session) {
    if (pipeline_->rendered && pipeline_->rendered->session.get() == &session) {
        pipeline_->finishing.wait();
        pipeline_->rendered.reset();
    }
}

/// Waits for all that was rendered to be sent; true where some of it had not been learnt.
bool SessionLoop::finish_rendered() {
    bool const learns = pipeline_->is_unlearnt();
    if (learns) {
        start_finishing();
    }
    wait_for_finishing();
    return learns;
}

/// Forgets viewers whose session has ended. Parked ones are kept, and take no share of the time.
void SessionLoop::forget_ended() {
    auto const has_ended = [](auto const& entry) { return !entry.second->session->is_served(); };
    for (auto const& [id, viewer] : viewers_) {
        if (!viewer->session->is_open()) {
            viewer->rendered.reset();
        }
    }
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
