#include "client/window/viewer.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <utility>

#include "client/core/display_pace.h"
#include "common/counted.h"
#include "common/error.h"
#include "common/files/picture_writer.h"

namespace framelet {

namespace {

constexpr double clock_step = 1.0 / 30;
constexpr float exposure_step = 0.25f;
constexpr float largest_exposure = 16;
constexpr double seek_step = 1;
constexpr double note_seconds = 2;
/// How often to look around while nothing happens: figures on the overlay, a note to take away.
constexpr double idle_seconds = 0.25;

} // namespace

Viewer::Viewer(Window& window, ConnectionOptions connection, std::unique_ptr<ClientCore> core,
               ViewerSettings const& settings, double lag_seconds)
    : window_(window), connection_(std::move(connection)), overlay_(window.handle(), window.content_scale()),
      settings_(settings), lag_seconds_(lag_seconds),
      chosen_lag_seconds_(lag_seconds > 0 ? lag_seconds : usual_lag_seconds) {
    adopt(std::move(core));
    say(core_->notice().empty() ? "F1: help" : core_->notice());
}

std::unique_ptr<ClientCore> Viewer::connect(ConnectionOptions const& connection) {
    return std::make_unique<ClientCore>(connection, [] { Window::wake(); });
}

double Viewer::seconds_now() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Viewer::adopt(std::unique_ptr<ClientCore> core) {
    bool const same_scene = core_ && core->welcome().scene_identity != 0 &&
                            core->welcome().scene_identity == core_->welcome().scene_identity;
    core_ = std::move(core);
    if (!core_->notice().empty()) {
        std::cerr << "framelet-viewer: " << core_->notice() << std::endl;
    }
    lost_.clear();
    meter_ = RateMeter();
    core_->set_settings(settings_);
    core_->set_smoothing(lag_seconds_);
    if (same_scene) {
        scene_number_ = core_->scene_number();
    } else {
        look_at_scene();
    }
}

/// As one looks at a scene at first. One of the same name is the same after a change: one goes on looking from where
/// one is.
void Viewer::look_at_scene() {
    Welcome const welcome = core_->welcome();
    scene_number_ = core_->scene_number();
    bool const is_changed = controller_ && welcome.scene_name == scene_name_;
    std::optional<Camera> const before = is_changed ? std::optional(controller_->camera()) : std::nullopt;
    scene_name_ = welcome.scene_name;
    controller_.emplace(welcome.start_camera, welcome.scene_bounds);
    if (before) {
        controller_->set_camera(*before);
    }
    if (!before || scene_camera_ >= static_cast<int>(welcome.cameras.size())) {
        scene_camera_ = start_scene_camera(welcome);
    }
    window_.set_title(welcome.scene_name + " - framelet-viewer");
}

int Viewer::run() {
    double last_look = seconds_now();
    double next_frame = 0;
    bool moving = false;
    bool pending = true; // there may be something to show in the next display frame
    bool redraw = true;
    int overlay_frames = 0; ///< to be drawn for its sake
    OverlayContent shown;
    while (!quit_) {
        bool const hidden = window_.is_hidden();
        if (hidden != settings_.paused) {
            settings_.paused = hidden;
            core_->set_settings(settings_);
            redraw = true;
        }
        WindowInput const input = window_.wait(pending && !hidden ? next_frame - seconds_now() : idle_seconds);
        double const now = seconds_now();
        moving = apply(input, moving ? now - last_look : 0);
        last_look = now;
        redraw = redraw || input.redraw;
        // What the mouse presses is seen in one frame, what it releases in the next, and what came of it in a third.
        overlay_frames = input.touched_overlay ? 3 : overlay_frames;
        watch_connection();
        if (lost_.empty()) {
            core_->set_view(controller_->camera(), window_.framebuffer_size(), scene_camera_);
        }
        pending = true;
        if (hidden || now < next_frame) {
            continue; // what has come is shown in the next display frame
        }
        redraw = update_shown_picture() || redraw;
        OverlayContent content = overlay_content();
        redraw = redraw || moving || overlay_frames > 0 || content != shown;
        pending = redraw;
        if (redraw) {
            window_.draw_picture();
            OverlayActions const asked = overlay_.draw(content);
            window_.set_overlay_area(overlay_.mouse_area());
            apply(asked);
            meter_.frame(seconds_now() - now);
            window_.present();
            showing_.note(seconds_now() - made_);
            shown = std::move(content);
            // A little early: where the swap waits for the display, that sets the pace.
            next_frame = now + 0.9 / window_.refresh_rate();
            redraw = false;
            overlay_frames = std::max(overlay_frames - 1, 0);
        }
    }
    return lost_.empty() ? 0 : 1;
}

/// Uploads what has changed; true when something has.
bool Viewer::update_shown_picture() {
    double const until_seen = core_->making_seconds() + showing_.expected();
    bool const changed = core_->update_picture(picture_, changed_, Clock::now() + DisplayPace::duration(until_seen));
    made_ = seconds_now();
    bool const toggled = std::exchange(overlay_toggled_, false) && !picture_.rgba.empty();
    if (!changed && !toggled) {
        return false;
    }
    bool const draws = drawn_over_ != DrawnOver::nothing;
    if (draws || toggled) { // what is drawn ages everywhere
        changed_.assign(1, {0, 0, picture_.width, picture_.height});
    }
    if (draws) {
        overlaid_ = picture_;
        core_->draw_overlay(drawn_over_, overlaid_);
    }
    window_.upload(draws ? overlaid_ : picture_, changed_);
    return true;
}

/// Returns true while a key keeps the camera moving.
bool Viewer::apply(WindowInput const& input, double seconds) {
    for (Command const command : input.commands) {
        apply(command);
    }
    take_pivot(input);
    if (input.moved_camera()) {
        leave_scene_camera();
        if (std::optional<Vec3> const point = std::exchange(grabbed_, std::nullopt)) {
            controller_->set_pivot(*point);
        }
        Viewport const viewport = window_.framebuffer_size();
        controller_->orbit(input.orbit, viewport);
        controller_->pan(input.pan, viewport);
        controller_->dolly(input.dolly);
        controller_->fly(input.fly, seconds);
    }
    return input.fly.moving();
}

/// What lies under the pointer is what the hands take hold of; where that is not known the pivot stays.
void Viewer::take_pivot(WindowInput const& input) {
    std::optional<Vec2> const place = input.focused ? input.focused : input.grabbed;
    if (!place) {
        return;
    }
    grabbed_ = core_->point_at(*place);
    if (!input.focused) {
        return;
    }
    if (std::optional<Vec3> const point = std::exchange(grabbed_, std::nullopt)) {
        leave_scene_camera();
        controller_->focus(*point);
    } else {
        say("nothing is there to look at");
    }
}

void Viewer::apply(OverlayActions const& asked) {
    for (Command const command : asked.commands) {
        apply(command);
    }
    if (asked.seek) {
        ClockState clock = core_->clock();
        clock.time = *asked.seek;
        ask_clock(ClockRequest::time, clock);
    }
}

void Viewer::apply(Command command) {
    ClockState clock = core_->clock();
    switch (command) {
    case Command::quit:
        quit_ = true;
        break;
    case Command::reset:
    case Command::reconnect:
        if (!lost_.empty()) {
            if (!reconnecting_.valid()) {
                reconnecting_ = std::async(std::launch::async, [options = connection_] {
                    auto core = connect(options);
                    Window::wake();
                    return core;
                });
            }
        } else if (command == Command::reset) {
            scene_camera_ = start_scene_camera(core_->welcome());
            controller_->reset();
        }
        break;
    case Command::play_or_pause:
        clock.playing = !clock.playing;
        ask_clock(ClockRequest::playing, clock);
        break;
    case Command::step_forward:
        step_clock(clock_step);
        break;
    case Command::step_back:
        step_clock(-clock_step);
        break;
    case Command::seek_start:
        clock.time = 0;
        ask_clock(ClockRequest::time, clock);
        break;
    case Command::seek_forward:
    case Command::seek_back:
        clock.time =
            std::clamp(clock.time + (command == Command::seek_forward ? seek_step : -seek_step), 0.0, max_scene_time);
        ask_clock(ClockRequest::time, clock);
        break;
    case Command::faster:
    case Command::slower:
        clock.speed =
            std::clamp(clock.speed * (command == Command::faster ? 2 : 0.5f), -max_clock_speed, max_clock_speed);
        ask_clock(ClockRequest::speed, clock);
        break;
    case Command::brighter:
        change_exposure(exposure_step);
        break;
    case Command::darker:
        change_exposure(-exposure_step);
        break;
    case Command::fit_scene:
        leave_scene_camera();
        controller_->fit(window_.framebuffer_size());
        break;
    case Command::free_camera:
        leave_scene_camera();
        break;
    case Command::toggle_fullscreen:
        window_.toggle_fullscreen();
        break;
    case Command::toggle_help:
        show_help_ = !show_help_;
        break;
    case Command::toggle_statistics:
        show_statistics_ = !show_statistics_;
        statistics_.clear();
        break;
    case Command::toggle_time_line:
        show_time_line_ = !show_time_line_;
        break;
    case Command::next_overlay:
        drawn_over_ = drawn_over_ == DrawnOver::nothing    ? DrawnOver::outlines
                      : drawn_over_ == DrawnOver::outlines ? DrawnOver::confidence
                                                           : DrawnOver::nothing;
        overlay_toggled_ = true;
        break;
    case Command::toggle_reprojection:
        settings_.reproject = !settings_.reproject;
        core_->set_settings(settings_);
        say(settings_.reproject ? "moved to where it is now" : "shown where it was rendered");
        break;
    case Command::toggle_smoothing:
        toggle_smoothing();
        break;
    case Command::screenshot:
        save_screenshot();
        break;
    default:
        choose_scene_camera(static_cast<int>(command) - static_cast<int>(Command::scene_camera));
    }
}

/// Empty: it is ours to set.
std::string Viewer::clock_fixed_because() const {
    bool const is_gone = interrupted_ || !lost_.empty();
    return is_gone ? "the server is gone: its clock cannot be set" : core_->controls() ? "" : watching_text;
}

void Viewer::ask_clock(std::uint8_t fields, ClockState const& state) {
    if (std::string reason = clock_fixed_because(); !reason.empty()) {
        say(std::move(reason));
        return;
    }
    core_->request_clock({fields, state});
    say("clock " + clock_text(core_->clock()));
}

void Viewer::step_clock(double seconds) {
    ClockState clock = core_->clock();
    clock.time = std::clamp(clock.time + seconds, 0.0, max_scene_time);
    clock.playing = false;
    ask_clock(ClockRequest::time | ClockRequest::playing, clock);
}

void Viewer::choose_scene_camera(int number) {
    std::vector<SceneCameraInfo> const cameras = core_->welcome().cameras;
    if (number >= static_cast<int>(cameras.size())) {
        say(cameras.empty() ? "the scene has no cameras of its own"
                            : "the scene has only " + counted(cameras.size(), "camera"));
        return;
    }
    scene_camera_ = number;
    std::string const& name = cameras[static_cast<std::size_t>(number)].name;
    say("camera " + std::to_string(number + 1) + (name.empty() ? "" : ": " + name));
}

void Viewer::leave_scene_camera() {
    if (scene_camera_ >= 0) {
        scene_camera_ = -1;
        controller_->set_camera(core_->shown_camera());
        say("free camera");
    }
}

void Viewer::change_exposure(float stops) {
    settings_.exposure_ev = std::clamp(settings_.exposure_ev + stops, -largest_exposure, largest_exposure);
    core_->set_settings(settings_);
    std::ostringstream text;
    text << "exposure " << std::showpos << settings_.exposure_ev << " EV";
    say(text.str());
}

void Viewer::toggle_smoothing() {
    lag_seconds_ = lag_seconds_ > 0 ? 0 : chosen_lag_seconds_;
    core_->set_smoothing(lag_seconds_);
    say(lag_seconds_ > 0 ? "smooth, " + lag_text(lag_seconds_) : "going on from what is newest");
}

void Viewer::save_screenshot() {
    if (picture_.rgba.empty()) {
        say("there is no picture yet");
        return;
    }
    std::time_t const now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    std::ostringstream name;
    name << "framelet-" << std::put_time(&local, "%Y%m%d-%H%M%S") << ".png";
    try {
        write_png(name.str(), picture_);
        say("saved " + name.str());
    } catch (InputError const& error) {
        say(error.what());
    }
}

void Viewer::say(std::string note) {
    note_ = std::move(note);
    note_until_ = seconds_now() + note_seconds;
}

void Viewer::watch_connection() {
    if (reconnecting_.valid() && reconnecting_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        try {
            adopt(reconnecting_.get());
        } catch (std::exception const& error) {
            lost_ = error.what();
            std::cerr << "framelet-viewer: " << lost_ << std::endl;
        }
    }
    if (lost_.empty()) {
        if (std::optional<std::string> reason = core_->end_reason()) {
            lost_ = std::move(*reason);
            std::cerr << "framelet-viewer: " << lost_ << std::endl;
        }
    }
    std::optional<std::string> const interruption = core_->interruption();
    if (interruption && !interrupted_) {
        std::cerr << "framelet-viewer: " << *interruption << "; trying to connect again" << std::endl;
    }
    interrupted_ = interruption.has_value();
    if (core_->scene_number() != scene_number_) {
        look_at_scene();
    }
    bool const controls = core_->controls();
    if (controls != controlled_) {
        say(controls ? "you control the scene's clock now" : watching_text);
    }
    controlled_ = controls;
}

OverlayContent Viewer::overlay_content() {
    OverlayContent out;
    if (show_help_) {
        out.help = help_rows(core_->controls());
    }
    if (show_statistics_) {
        ClientStatistics const statistics = core_->statistics();
        if (meter_.update(seconds_now(), statistics.bytes) || statistics_.empty()) {
            statistics_ =
                statistics_rows(statistics, meter_, core_->clock(), core_->controls(), window_.framebuffer_size());
        }
        out.statistics = statistics_;
    }
    if (show_time_line_) {
        out.time_line = {core_->clock(), core_->welcome().animation_duration, clock_fixed_because(),
                         settings_.exposure_ev};
    }
    if (seconds_now() < note_until_) {
        out.note = note_;
    }
    if (interrupted_) {
        out.sign = "no connection: trying again";
    }
    if (reconnecting_.valid()) {
        out.message = "connecting to " + connection_.server.text() + " ...";
    } else if (!lost_.empty()) {
        out.message = lost_ + "\n\nR or Enter: connect again     Esc: quit";
    } else if (picture_.rgba.empty()) {
        out.message = "waiting for the first picture ...";
    }
    return out;
}

} // namespace framelet
