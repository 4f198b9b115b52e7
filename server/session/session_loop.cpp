#include "server/session/session_loop.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "common/color.h"

namespace framelet {

/// The batch being encoded while the next one renders.
struct SessionLoop::Encoding {
    tbb::task_group task;
    BatchCodec codec;
    Batch batch;
    std::vector<Framelet> rendered; ///< being encoded
    std::vector<Framelet> spare; ///< being rendered into
    float exposure = 1;
    std::shared_ptr<Session> session;

    void run() {
        batch.framelets.resize(rendered.size());
        std::transform(rendered.begin(), rendered.end(), batch.framelets.begin(),
                       [this](Framelet const& framelet) { return to_display(framelet, exposure); });
        session->send(codec.encode(batch));
    }
};

SessionLoop::SessionLoop(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene,
                         SceneClock const& clock, LoopOptions options, Events events)
    : scene_(scene), clips_(std::move(clips)), animated_(animation_duration(scene, clips_) > 0),
      render_scene_(render_scene), clock_(clock), options_(options), events_(std::move(events)),
      pose_(evaluate_pose(scene, clips_, 0)), encoding_(std::make_unique<Encoding>()) {
    render_scene_.set_pose(pose_);
}

SessionLoop::~SessionLoop() {
    finish_encoding();
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
        if (rendered) {
            continue;
        }
        // Nothing to do until a viewer or the clock says so. While the clock runs every display frame is worth a look.
        finish_encoding();
        bool const playing = animated_ && clock_.state(std::chrono::steady_clock::now()).playing && !sessions.empty();
        std::unique_lock lock(mutex_);
        auto const woken = [this] { return wake_ || stop_; };
        if (playing) {
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
    double const share = options_.cycle_seconds / static_cast<double>(sessions.size());
    bool rendered = false;
    for (auto const& session : sessions) {
        rendered |= render_session(*session, refreshes_[session->id()], time, share);
    }
    return rendered;
}

bool SessionLoop::render_session(Session& session, ViewRefresh& refresh, SceneTime time, double cycle_seconds) {
    SessionInput const input = session.newest_input();
    if (!input.camera) {
        return false;
    }
    ViewState const state{resolve_camera(*input.camera), options_.exposure * std::exp2(input.settings.exposure_ev),
                          time};
    if (is_complete(refresh, state)) {
        if (session.report(input.version, true)) {
            events_.convergence_changed();
        }
        return false;
    }
    std::uint64_t const number = session.begin_batch();
    if (number == 0) {
        return false;
    }
    std::vector<Tile> const tiles =
        next_tiles(refresh, state, rate_.samples_per_second * cycle_seconds, options_.batch_framelets);

    auto const start = std::chrono::steady_clock::now();
    encoding_->spare.resize(tiles.size());
    render_framelets(render_scene_, state.view.camera, refresh.plane, tiles, 0, encoding_->spare);
    std::chrono::duration<double> const seconds = std::chrono::steady_clock::now() - start;
    rate_ = update_render_rate(rate_, static_cast<double>(tiles.size() * framelet_samples), seconds.count());
    samples_per_second_ = rate_.samples_per_second;

    finish_encoding();
    std::swap(encoding_->rendered, encoding_->spare);
    encoding_->batch.number = number;
    encoding_->batch.view = state.view;
    encoding_->batch.scene_time = time;
    encoding_->exposure = state.exposure;
    encoding_->session = session.shared_from_this();
    encoding_->task.run([encoding = encoding_.get()] { encoding->run(); });

    if (session.report(input.version, is_complete(refresh, state))) {
        events_.convergence_changed();
    }
    return true;
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

void SessionLoop::finish_encoding() {
    encoding_->task.wait();
    encoding_->session.reset();
}

void SessionLoop::forget_ended(Sessions const& sessions) {
    auto const is_open = [&sessions](std::uint64_t id) {
        return std::any_of(sessions.begin(), sessions.end(), [id](auto const& session) { return session->id() == id; });
    };
    std::erase_if(refreshes_, [&](auto const& entry) { return !is_open(entry.first); });
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
