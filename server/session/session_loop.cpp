#include "server/session/session_loop.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "common/color.h"

namespace framelet {
namespace {

/// Samples a second of a renderer that has not been measured yet.
constexpr double first_rate = 1e6;

/// All but the radiance; what `from` has room for is reused.
void move_geometry(Framelet& from, Framelet& to) {
    to.tile = from.tile;
    to.depth = from.depth;
    to.body.swap(from.body);
    to.velocity.swap(from.velocity);
    to.reflects = from.reflects;
}

/// Seconds from lap to lap.
class Laps {
public:
    double lap() {
        auto const now = std::chrono::steady_clock::now();
        return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

} // namespace

/// The batch being encoded while the next one renders.
struct SessionLoop::Encoding {
    tbb::task_group task;
    BatchCodec codec;
    Batch batch;
    std::shared_ptr<Session> session;

    void run() { session->send_batch(codec.encode(batch, session->held_picture())); }
};

SessionLoop::SessionLoop(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene,
                         SceneClock const& clock, LoopOptions options, Events events)
    : scene_(scene), clips_(std::move(clips)), animated_(animation_duration(scene, clips_) > 0),
      render_scene_(render_scene), clock_(clock), options_(options), events_(std::move(events)),
      pose_(evaluate_pose(scene, clips_, 0)), encoding_(std::make_unique<Encoding>()) {
    render_scene_.set_clips(clips_);
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
        rendered |= render_session(*session, viewers_[session->id()], time, share);
    }
    return rendered;
}

bool SessionLoop::render_session(Session& session, Viewer& viewer, SceneTime time, double share) {
    AdaptiveRefresh& refresh = viewer.refresh;
    SessionInput const input = session.newest_input();
    if (!input.camera) {
        return false;
    }
    ViewState const state{resolve_camera(*input.camera), options_.exposure * std::exp2(input.settings.exposure_ev),
                          time};
    if (refresh.is_complete(state)) {
        if (!viewer.lossy.empty()) {
            return send_exactly(session, viewer, input, state);
        }
        if (session.report(input.version, true)) {
            events_.convergence_changed();
        }
        return false;
    }
    if (!session.has_room()) {
        waits_for_room_ = true;
        return false;
    }
    auto const start = std::chrono::steady_clock::now();
    RefreshInput wanted;
    wanted.state = state;
    wanted.now = std::chrono::duration<double>(start.time_since_epoch()).count();
    LinkState const link = session.link();
    double const rendered = share * (rate_.samples_per_second > 0 ? rate_.samples_per_second : first_rate);
    std::uint8_t const quality = input.takes_loss() ? viewer.choice.choose(link, rendered, wanted.now) : exact_quality;
    bool const still = refresh.is_still(state);
    wanted.samples_per_second = bounded_rate(link, rendered);
    wanted.cycle_seconds = cycle_length(still, plan_seconds_);
    wanted.delivery_seconds = static_cast<float>(link.delivery_seconds);
    wanted.bias = std::clamp(static_cast<float>(options_.bias) + input.settings.bias, -1.0f, 1.0f);
    wanted.batch_framelets = options_.batch_framelets;
    wanted.link_framelets = bounded_batch(link);
    wanted.reprojects = input.takes_shapes();
    CycleRecord record;
    Laps laps;
    RefreshPlan const& plan = refresh.plan(wanted);
    record.stage_seconds.plan = laps.lap();
    if (plan.is_new_cycle) {
        constexpr double weight = 0.1;
        plan_seconds_ += weight * (record.stage_seconds.plan - plan_seconds_);
    }
    if (plan.tiles.empty() && plan.probes.empty()) {
        return false;
    }
    render_plan(plan.tiles, plan.probes, state);
    record.stage_seconds.render = laps.lap();
    needed_ = refresh.learn(display_, rendered_, probes_.luma());
    record.stage_seconds.learn = laps.lap();
    choose_qualities(ImagePlane(state.view.viewport), plan.tiles, needed_, quality, still, viewer.lossy, qualities_);
    shapes_.clear();
    tracks_.clear();
    if (input.takes_shapes() && std::ranges::count(needed_, 0) < std::ssize(needed_)) { // else nothing is sent
        describe_shapes(viewer, needed_, state);
    }
    record.stage_seconds.shape = laps.lap();
    finish_encoding();
    record.stage_seconds.wait = laps.lap();
    send_batch(session, state);

    if (!plan.tiles.empty()) {
        // Planning left out: it takes as long for few samples, which would then seem to be dear.
        double const samples = static_cast<double>(plan.tiles.size() * framelet_samples);
        rate_ = update_render_rate(
            rate_, samples, record.stage_seconds.render + record.stage_seconds.learn + record.stage_seconds.shape);
        samples_per_second_ = rate_.samples_per_second;
    }
    if (options_.recorder != nullptr) {
        record.session = session.id();
        record.scene_time = time;
        record.samples_rendered = plan.tiles.size() * framelet_samples;
        record.probes = plan.probes.size();
        record.framelets_sent =
            static_cast<std::uint64_t>(std::ranges::count_if(needed_, [](auto n) { return n != 0; }));
        record.framelets_unchanged = needed_.size() - record.framelets_sent;
        options_.recorder->add(record, refresh, wanted.now);
    }
    if (session.report(input.version, refresh.is_complete(state) && viewer.lossy.empty())) {
        events_.convergence_changed();
    }
    return true;
}

/// The picture is complete, but for what the viewer was sent with loss: some of that once more.
bool SessionLoop::send_exactly(Session& session, Viewer& viewer, SessionInput const& input, ViewState const& state) {
    if (!session.has_room()) {
        waits_for_room_ = true;
        return false;
    }
    constexpr std::size_t most_framelets = 1024;
    viewer.lossy.list(std::min(bounded_batch(session.link()), most_framelets), lossy_tiles_);
    render_plan(lossy_tiles_, {}, state);
    needed_.assign(lossy_tiles_.size(), 1);
    choose_qualities(ImagePlane(state.view.viewport), lossy_tiles_, needed_, exact_quality, true, viewer.lossy,
                     qualities_);
    shapes_.clear();
    tracks_.clear();
    if (input.takes_shapes()) {
        describe_shapes(viewer, needed_, state);
    }
    finish_encoding();
    send_batch(session, state);
    return true;
}

void SessionLoop::render_plan(std::span<Tile const> tiles, std::span<Probe const> probes, ViewState const& state) {
    std::size_t const count = tiles.size();
    rendered_pool_.resize(std::max(rendered_pool_.size(), count));
    display_pool_.resize(std::max(display_pool_.size(), count));
    rendered_ = std::span(rendered_pool_).first(count);
    display_ = std::span(display_pool_).first(count);
    Camera const& camera = state.view.camera;
    ImagePlane const plane(state.view.viewport);
    ViewRays const rays = make_view_rays(camera, state.view.viewport);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        Framelet& fresh = fresh_.local();
        render_framelet(render_scene_, rays, plane, tiles[i], 0, fresh);
        display_[i] = to_display(fresh, state.exposure);
        move_geometry(fresh, rendered_[i]);
    });
    probes_.render(render_scene_, camera, state.view.viewport, state.exposure, probes);
}

void SessionLoop::describe_shapes(Viewer& viewer, std::vector<std::uint8_t> const& needed, ViewState const& state) {
    ViewRays const rays = make_view_rays(state.view.camera, state.view.viewport);
    viewer.shapes.fit(rendered_, needed, rays, ImagePlane(state.view.viewport), shapes_);
    viewer.shapes.track(scene_, clips_, render_scene_.bodies(), state.scene_time, tracks_);
}

void SessionLoop::send_batch(Session& session, ViewState const& state) {
    Batch& batch = encoding_->batch;
    batch.framelets.clear();
    for (std::size_t i = 0; i < display_.size(); ++i) {
        if (needed_[i] != 0) {
            batch.framelets.push_back(display_[i]);
        }
    }
    if (batch.framelets.empty() || !session.is_open()) {
        return;
    }
    batch.number = session.begin_batch(static_cast<double>(batch.framelets.size() * framelet_samples));
    batch.quality = qualities_;
    batch.view = state.view;
    batch.scene_time = state.scene_time;
    batch.shapes.swap(shapes_);
    batch.tracks.swap(tracks_);
    encoding_->session = session.shared_from_this();
    encoding_->task.run([encoding = encoding_.get()] { encoding->run(); });
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
    std::erase_if(viewers_, [&](auto const& entry) { return !is_open(entry.first); });
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
