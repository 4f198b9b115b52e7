#include "client/core/client_core.h"

#include <algorithm>
#include <utility>

#include "client/core/picture/display_timing.h"
#include "common/error.h"

namespace framelet {

Welcome ClientCore::welcome() const {
    std::lock_guard const lock(mutex_);
    return welcome_;
}

std::uint64_t ClientCore::scene_number() const {
    std::lock_guard const lock(mutex_);
    return scene_number_;
}

void ClientCore::set_view(Camera const& wanted, Viewport viewport, int scene_camera) {
    Camera const camera = within_bounds(wanted); // the user may have moved it out of bounds
    std::lock_guard const lock(mutex_);
    if (!asked_.equals(camera, viewport, scene_camera)) {
        has_picture_ = has_picture_ && asked_.has_viewport(viewport);
        asked_.set(camera, viewport, scene_camera, Clock::now());
    }
    send_view();
}

void ClientCore::set_settings(ViewerSettings const& settings) {
    {
        std::lock_guard const lock(mutex_);
        viewer_settings_ = settings;
        picture_settings_.reproject = settings.reproject;
    }
    connection_->send(settings);
}

void ClientCore::set_smoothing(double lag_seconds) {
    FRAMELET_CHECK(lag_seconds >= 0 && lag_seconds <= max_lag_seconds);
    std::lock_guard const lock(mutex_);
    picture_settings_.lag_seconds = lag_seconds;
}

void ClientCore::request_clock(ClockRequest const& request) {
    {
        std::lock_guard const lock(mutex_);
        if (interruption_ || !server_.status().controls) {
            return;
        }
        server_.ask_clock(request, Clock::now());
    }
    connection_->send(request);
}

bool ClientCore::update_picture(Picture& picture, std::vector<PixelRect>& changed, Clock::time_point shown_at,
                                BlockCanvas* canvas) {
    changed.clear();
    Clock::time_point const called = Clock::now();
    {
        std::lock_guard const lock(mutex_);
        send_view();
        if (!asked_.exists()) {
            return false;
        }
        shown_at = std::max({shown_at, shown_at_, called + DisplayTiming::duration(making_.expected())});
        shown_at_ = shown_at;
    }
    Clock::time_point begun, made;
    bool drawn = false;
    ShownPicture shown;
    {
        std::lock_guard const picture_lock(picture_mutex_);
        take_in();
        begun = Clock::now();
        drawn = pictures_.show(picture_request(), picture, changed, canvas);
        made = Clock::now();
        PictureMaker const& maker = *pictures_.shown();
        shown = maker.last_shown();
        if (is_clean_start() && !drawn) {
            picture = bare_picture(maker.viewport());
            std::lock_guard const lock(mutex_);
            shown_.is_on_canvas = false;
            changed.assign(1, {0, 0, picture.width, picture.height});
            return true;
        }
    }
    std::lock_guard const lock(mutex_);
    if (shown.camera_number == 0) { // nothing has been shown, and the start camera stays
        shown.camera = shown_.camera;
    }
    shown_ = shown;
    statistics_.photon_seconds = drawn ? photon_seconds(std::max(shown_at, made)) : -1;
    if (!drawn) {
        return false;
    }
    for (PixelRect const& rect : changed) {
        statistics_.pixels += static_cast<std::uint64_t>(rect.width()) * static_cast<std::uint64_t>(rect.height());
    }
    statistics_.reconstruct_seconds += seconds_between(begun, made);
    making_.note(seconds_between(called, made));
    ++statistics_.pictures;
    if (statistics_.first_picture_seconds < 0 && asked_.first_sent()) {
        statistics_.first_picture_seconds = seconds_between(*asked_.first_sent(), made);
    }
    return true;
}

bool ClientCore::is_on_canvas() const {
    std::lock_guard const lock(mutex_);
    return shown_.is_on_canvas;
}

double ClientCore::making_seconds() const {
    std::lock_guard const lock(mutex_);
    return making_.expected();
}

void ClientCore::set_drawn_over(DrawnOver what) {
    std::lock_guard const lock(mutex_);
    drawn_over_ = what;
}

void ClientCore::draw_overlay(Picture& picture) {
    std::lock_guard const lock(picture_mutex_);
    if (PictureMaker* const maker = pictures_.shown()) {
        maker->draw_over(picture);
    }
}

bool ClientCore::overlay_fades() const {
    {
        std::lock_guard const lock(mutex_);
        if (drawn_over_ != DrawnOver::refresh_rate) {
            return false;
        }
    }
    std::lock_guard const lock(picture_mutex_);
    PictureMaker const* const maker = pictures_.shown();
    return maker != nullptr && maker->drawn_over_fades();
}

std::optional<Vec3> ClientCore::point_at(Vec2 position) const {
    std::lock_guard const lock(picture_mutex_);
    PictureMaker const* const maker = pictures_.shown();
    return maker == nullptr ? std::nullopt : maker->point_at(position);
}

std::vector<float> ClientCore::picture_depths() const {
    std::lock_guard const lock(picture_mutex_);
    PictureMaker const* const maker = pictures_.shown();
    return maker == nullptr ? std::vector<float>() : maker->depths();
}

bool ClientCore::wait_for_news(std::chrono::nanoseconds at_most) {
    std::unique_lock lock(mutex_);
    news_arrived_.wait_for(lock, at_most, [this] { return news_; });
    return std::exchange(news_, false);
}

std::optional<std::string> ClientCore::end_reason() const {
    std::lock_guard const lock(mutex_);
    return end_reason_;
}

std::optional<std::string> ClientCore::interruption() const {
    std::lock_guard const lock(mutex_);
    return interruption_;
}

bool ClientCore::controls() const {
    std::lock_guard const lock(mutex_);
    return server_.status().controls;
}

bool ClientCore::is_complete() const {
    std::lock_guard const lock(mutex_);
    return shows_all();
}

Status ClientCore::status() const {
    std::lock_guard const lock(mutex_);
    return server_.status();
}

ClockState ClientCore::clock() const {
    std::lock_guard const lock(mutex_);
    return server_.clock_at(Clock::now());
}

Camera ClientCore::shown_camera() const {
    std::lock_guard const lock(mutex_);
    return shown_.camera;
}

ClientStatistics ClientCore::statistics() const {
    std::lock_guard const lock(mutex_);
    ClientStatistics out = statistics_;
    out.seconds = seconds_between(start_, Clock::now());
    out.waiting_bytes = arrived_.bytes();
    out.converged = shows_all();
    return out;
}

} // namespace framelet
