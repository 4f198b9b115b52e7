#include "client/core/client_core.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "client/core/client_session.h"
#include "client/core/picture/display_timing.h"
#include "common/error.h"

namespace framelet {

namespace {

using Clock = ClientSession::Clock;

} // namespace

ClientCore::ClientCore(ConnectionOptions const& options, std::function<void()> on_news)
    : session_(std::make_unique<ClientSession>(options, std::move(on_news))) {}

ClientCore::~ClientCore() = default;

Welcome ClientCore::welcome() const {
    std::lock_guard const lock(session_->mutex);
    return session_->welcome;
}

std::uint64_t ClientCore::scene_number() const {
    std::lock_guard const lock(session_->mutex);
    return session_->scene_number;
}

void ClientCore::set_view(Camera const& wanted, Viewport viewport, int scene_camera) {
    Camera const camera = within_bounds(wanted); // the user may have moved it out of bounds
    std::lock_guard const lock(session_->mutex);
    AskedView& asked = session_->asked;
    if (!asked.equals(camera, viewport, scene_camera)) {
        session_->has_picture = session_->has_picture && asked.has_viewport(viewport);
        asked.set(camera, viewport, scene_camera, Clock::now());
    }
    session_->send_view();
}

void ClientCore::set_settings(ViewerSettings const& settings) {
    {
        std::lock_guard const lock(session_->mutex);
        session_->viewer_settings = settings;
        session_->picture_settings.reproject = settings.reproject;
    }
    session_->connection->send(settings);
}

void ClientCore::set_smoothing(double lag_seconds) {
    FRAMELET_CHECK(lag_seconds >= 0 && lag_seconds <= max_lag_seconds);
    std::lock_guard const lock(session_->mutex);
    session_->picture_settings.lag_seconds = lag_seconds;
}

void ClientCore::request_clock(ClockRequest const& request) {
    {
        std::lock_guard const lock(session_->mutex);
        if (session_->interruption || !session_->server.status().controls) {
            return;
        }
        session_->server.ask_clock(request, Clock::now());
    }
    session_->connection->send(request);
}

bool ClientCore::update_picture(Picture& picture, std::vector<PixelRect>& changed, Clock::time_point shown_at,
                                BlockCanvas* canvas) {
    ClientSession& core = *session_;
    changed.clear();
    Clock::time_point const called = Clock::now();
    {
        std::lock_guard const lock(core.mutex);
        core.send_view();
        if (!core.asked.exists()) {
            return false;
        }
        shown_at = std::max({shown_at, core.shown_at, called + DisplayTiming::duration(core.making.expected())});
        core.shown_at = shown_at;
    }
    Clock::time_point begun, made;
    bool drawn = false;
    Camera camera;
    SceneTime time = 0;
    std::uint64_t camera_number = 0;
    bool is_on_canvas = false;
    {
        std::lock_guard const picture_lock(core.picture_mutex);
        core.take_in();
        begun = Clock::now();
        drawn = core.pictures.show(core.picture_request(), picture, changed, canvas);
        made = Clock::now();
        PictureMaker const& maker = core.pictures.shown();
        camera = maker.shown_camera();
        time = maker.shown_time();
        camera_number = maker.shown_camera_number();
        is_on_canvas = maker.is_on_canvas();
        if (core.is_clean_start() && !drawn) {
            picture = bare_picture(maker.viewport());
            std::lock_guard const lock(core.mutex);
            core.is_on_canvas = false;
            changed.assign(1, {0, 0, picture.width, picture.height});
            return true;
        }
    }
    std::lock_guard const lock(core.mutex);
    core.is_on_canvas = is_on_canvas;
    if (camera_number > 0) { // else nothing has been shown, and the start camera stays
        core.shown_camera = camera;
    }
    core.shown_time = time;
    core.statistics.photon_seconds = drawn ? core.photon_seconds(camera_number, std::max(shown_at, made)) : -1;
    if (!drawn) {
        return false;
    }
    for (PixelRect const& rect : changed) {
        core.statistics.pixels += static_cast<std::uint64_t>(rect.width()) * static_cast<std::uint64_t>(rect.height());
    }
    core.statistics.reconstruct_seconds += ClientSession::seconds_between(begun, made);
    core.making.note(ClientSession::seconds_between(called, made));
    ++core.statistics.pictures;
    if (core.statistics.first_picture_seconds < 0 && core.asked.first_sent()) {
        core.statistics.first_picture_seconds = ClientSession::seconds_between(*core.asked.first_sent(), made);
    }
    return true;
}

bool ClientCore::is_on_canvas() const {
    std::lock_guard const lock(session_->mutex);
    return session_->is_on_canvas;
}

double ClientCore::making_seconds() const {
    std::lock_guard const lock(session_->mutex);
    return session_->making.expected();
}

void ClientCore::set_drawn_over(DrawnOver what) {
    std::lock_guard const lock(session_->mutex);
    session_->drawn_over = what;
}

void ClientCore::draw_overlay(Picture& picture) {
    std::lock_guard const lock(session_->picture_mutex);
    if (session_->pictures.current() != nullptr) {
        session_->pictures.draw_over(picture);
    }
}

bool ClientCore::overlay_fades() const {
    {
        std::lock_guard const lock(session_->mutex);
        if (session_->drawn_over != DrawnOver::refresh_rate) {
            return false;
        }
    }
    std::lock_guard const lock(session_->picture_mutex);
    return session_->pictures.current() != nullptr && session_->pictures.drawn_over_fades();
}

std::optional<Vec3> ClientCore::point_at(Vec2 position) const {
    std::lock_guard const lock(session_->picture_mutex);
    return session_->pictures.current() == nullptr ? std::nullopt : session_->pictures.shown().point_at(position);
}

std::vector<float> ClientCore::picture_depths() const {
    std::lock_guard const lock(session_->picture_mutex);
    return session_->pictures.current() == nullptr ? std::vector<float>() : session_->pictures.shown().depths();
}

bool ClientCore::wait_for_news(std::chrono::nanoseconds at_most) {
    std::unique_lock lock(session_->mutex);
    session_->news_arrived.wait_for(lock, at_most, [this] { return session_->news; });
    return std::exchange(session_->news, false);
}

std::optional<std::string> ClientCore::end_reason() const {
    std::lock_guard const lock(session_->mutex);
    return session_->end_reason;
}

std::optional<std::string> ClientCore::interruption() const {
    std::lock_guard const lock(session_->mutex);
    return session_->interruption;
}

bool ClientCore::controls() const {
    std::lock_guard const lock(session_->mutex);
    return session_->server.status().controls;
}

bool ClientCore::is_complete() const {
    std::lock_guard const lock(session_->mutex);
    return session_->is_complete();
}

Status ClientCore::status() const {
    std::lock_guard const lock(session_->mutex);
    return session_->server.status();
}

ClockState ClientCore::clock() const {
    std::lock_guard const lock(session_->mutex);
    return session_->server.clock_at(Clock::now());
}

Camera ClientCore::shown_camera() const {
    std::lock_guard const lock(session_->mutex);
    return session_->shown_camera;
}

ClientStatistics ClientCore::statistics() const {
    std::lock_guard const lock(session_->mutex);
    ClientStatistics out = session_->statistics;
    out.seconds = ClientSession::seconds_between(session_->start, Clock::now());
    out.waiting_bytes = session_->arrived.bytes();
    out.converged = session_->is_complete();
    return out;
}

} // namespace framelet
