// Carries out what the hands and the keys ask of a viewer.
#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <utility>

#include "client/viewer/lacks.h"
#include "client/window/kept/film_file.h"
#include "client/window/kept/scene_memory.h"
#include "client/window/kept/user_files.h"
#include "client/window/viewer.h"
#include "common/counted.h"
#include "common/error.h"
#include "common/files/picture_writer.h"
#include "common/program_line.h"

namespace framelet {

namespace fs = std::filesystem;

namespace {

constexpr double clock_step = 1.0 / 30;
constexpr float exposure_step = 0.25f;
constexpr double seek_step = 1;
constexpr float bias_step = 0.25f;

} // namespace

/// Carries out what the hands did. Returns true while a key keeps the camera moving.
bool Viewer::apply(WindowInput const& input, double seconds) {
    for (Command const command : input.commands) {
        apply(command);
    }
    take_pivot(input);
    if (input.moved_camera()) {
        leave_scene_camera();
        is_at_bookmark_ = false;
        if (std::optional<Vec3> const point = std::exchange(grabbed_, std::nullopt)) {
            controller_->set_pivot(*point);
        }
        Viewport const viewport = window_.framebuffer_size();
        controller_->orbit(input.orbit, viewport);
        controller_->pan(input.pan, viewport);
        controller_->dolly(input.dolly);
        controller_->look(input.look, viewport);
        controller_->fly(input.fly, seconds);
    }
    if (input.speed != 0) {
        controller_->change_speed(input.speed);
        memory_.fly_speed = controller_->speed_factor();
        std::ostringstream text;
        float const speed = controller_->fly_speed();
        text << "flying at " << std::fixed << std::setprecision(speed < 10 ? 2 : 0) << speed << " m/s";
        say(text.str());
    }
    return input.fly.moving();
}

/// Takes hold of the point under the pointer; where that is not known the pivot stays.
void Viewer::take_pivot(WindowInput const& input) {
    std::optional<Vec2> const place = input.focused ? input.focused : input.grabbed;
    if (!place) {
        return;
    }
    // The picture may be shown stretched, while the window changes its size.
    Viewport const window = window_.framebuffer_size();
    grabbed_ = core_->point_at(*place * Vec2(static_cast<float>(picture_.width) / static_cast<float>(window.width),
                                             static_cast<float>(picture_.height) / static_cast<float>(window.height)));
    if (grabbed_ && !controller_->can_hold(present_camera(), *grabbed_)) {
        grabbed_.reset();
    }
    if (!input.focused) {
        return;
    }
    if (std::optional<Vec3> const point = std::exchange(grabbed_, std::nullopt)) {
        leave_scene_camera();
        is_at_bookmark_ = false;
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
    if (asked.scene_camera) {
        choose_scene_camera(*asked.scene_camera);
    }
    if (asked.bookmark) {
        go_to_bookmark(*asked.bookmark);
    }
    if (asked.renamed) {
        change_bookmarks(
            [&] { bookmarks_->rename(static_cast<std::size_t>(asked.renamed->bookmark), asked.renamed->name); });
    }
    if (asked.removed_bookmark) {
        remove_bookmark(*asked.removed_bookmark);
    }
    if (asked.server) {
        try_server(*asked.server);
    }
    if (asked.trusts && attempts_) {
        *asked.trusts ? attempts_->trust() : attempts_.reset();
    }
    if (asked.drawn_over) {
        draw_over(*asked.drawn_over);
    }
}

void Viewer::escape() {
    switch (escape_.press({window_.has_mouse_look(), overlay_.has_menu(), show_help_, window_.is_fullscreen()},
                          seconds_now())) {
    case EscapeLeaves::mouse_look:
        window_.set_mouse_look(false);
        break;
    case EscapeLeaves::menu:
        overlay_.close_menu();
        break;
    case EscapeLeaves::help:
        show_help_ = false;
        break;
    case EscapeLeaves::full_screen:
        window_.toggle_fullscreen();
        break;
    case EscapeLeaves::nothing_yet:
        say(escape_note(), EscapeKey::most_pause);
        break;
    case EscapeLeaves::program:
        quit_ = true;
    }
}

void Viewer::apply(Command command) {
    ClockState clock = core_->clock();
    switch (command) {
    case Command::quit:
        quit_ = true;
        break;
    case Command::mouse_look:
        window_.set_mouse_look(!window_.has_mouse_look());
        break;
    case Command::escape:
        escape();
        break;
    case Command::reset:
    case Command::reconnect:
        if (attempts_) {
            attempts_->hurry();
        } else if (!opener_.end_reason().empty()) {
            opener_.reopen();
        } else if (!lost_.empty()) {
            attempts_.emplace(connection_);
        } else if (command == Command::reset) {
            scene_camera_ = start_scene_camera(core_->welcome());
            is_at_bookmark_ = false;
            controller_->reset();
        }
        break;
    case Command::open_file:
        opener_.choose();
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
    case Command::sharper:
        change_bias(-bias_step);
        break;
    case Command::fresher:
        change_bias(bias_step);
        break;
    case Command::fit_scene:
        leave_scene_camera();
        is_at_bookmark_ = false;
        controller_->fit(window_.framebuffer_size(), overlay_.covered_below());
        break;
    case Command::view_front:
    case Command::view_back:
    case Command::view_right:
    case Command::view_left:
    case Command::view_top:
    case Command::view_below:
    case Command::toggle_projection:
        take_view(command);
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
        memory_.shows_statistics = !memory_.shows_statistics;
        break;
    case Command::toggle_details:
        memory_.shows_details = !memory_.shows_details;
        memory_.shows_statistics = memory_.shows_statistics || memory_.shows_details;
        break;
    case Command::toggle_time_line:
        memory_.shows_bar = !memory_.shows_bar;
        break;
    case Command::next_overlay:
        draw_over(next_of(drawn_over_));
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
        save_screenshot(false);
        break;
    case Command::screenshot_with_depth:
        save_screenshot(true);
        break;
    case Command::toggle_recording:
        toggle_recording();
        break;
    case Command::add_bookmark:
        add_bookmark();
        break;
    case Command::remove_bookmark:
        remove_bookmark(bookmark_);
        break;
    case Command::copy_camera:
        copy_camera(false);
        break;
    case Command::paste_camera:
        paste_camera();
        break;
    case Command::save_camera:
        copy_camera(true);
        break;
    default:
        if (command >= Command::bookmark) {
            go_to_bookmark(static_cast<int>(command) - static_cast<int>(Command::bookmark));
        } else {
            choose_scene_camera(static_cast<int>(command) - static_cast<int>(Command::scene_camera));
        }
    }
}

std::string Viewer::clock_lacks() const {
    return framelet::clock_lacks(interrupted_ || !lost_.empty(), core_->welcome().animation_duration > 0,
                                 core_->controls());
}

void Viewer::ask_clock(std::uint8_t fields, ClockState const& state) {
    if (std::string reason = clock_lacks(); !reason.empty()) {
        say(std::move(reason));
        return;
    }
    core_->request_clock({fields, state});
    say("clock " + clock_text(time_line()));
}

void Viewer::step_clock(double seconds) {
    ClockState clock = core_->clock();
    clock.time = std::clamp(clock.time + seconds, 0.0, max_scene_time);
    clock.playing = false;
    ask_clock(ClockRequest::time | ClockRequest::playing, clock);
}

void Viewer::change_exposure(float stops) {
    settings_.exposure_ev = std::clamp(settings_.exposure_ev + stops, -largest_exposure, largest_exposure);
    has_set_exposure_ = true;
    core_->set_settings(settings_);
    std::ostringstream text;
    text << "exposure " << std::showpos << settings_.exposure_ev << " EV";
    say(text.str());
}

void Viewer::change_bias(float step) {
    settings_.bias = std::clamp(settings_.bias + step, -1.0f, 1.0f);
    memory_.bias = settings_.bias;
    core_->set_settings(settings_);
    std::ostringstream text;
    text << (settings_.bias < 0   ? "sharper while things move, "
             : settings_.bias > 0 ? "newer while things move, "
                                  : "detail and newness alike, ")
         << std::showpos << settings_.bias;
    say(text.str());
}

void Viewer::toggle_smoothing() {
    std::string lacks = smoothing_lacks(core_->welcome().animation_duration > 0, settings_.reproject);
    if (!lacks.empty()) {
        say(std::move(lacks));
        return;
    }
    lag_seconds_ = lag_seconds_ > 0 ? 0 : chosen_lag_seconds_;
    memory_.lag_seconds = lag_seconds_;
    core_->set_smoothing(lag_seconds_);
    say(lag_seconds_ > 0 ? "smooth, " + lag_text(lag_seconds_) : "going on from what is newest");
}

void Viewer::draw_over(DrawnOver what) {
    drawn_over_ = what;
    core_->set_drawn_over(what);
    overlay_toggled_ = true;
}

void Viewer::save_screenshot(bool with_depth) {
    if (std::string lacks = picture_lacks(!picture_.rgba.empty()); !lacks.empty()) {
        say(std::move(lacks));
        return;
    }
    std::error_code error;
    fs::path const file = new_file_name(fs::current_path(error), with_depth ? ".exr" : ".png");
    std::string lacks;
    try {
        if (with_depth) {
            std::vector<float> depths = core_->picture_depths();
            if (4 * depths.size() != picture_.rgba.size()) { // none, or a picture of another size is shown for a while
                depths.clear();
                lacks = ", without depth: it is not known here";
            }
            write_exr(file, shown_picture(), depths);
        } else {
            write_png(file, shown_picture());
        }
        say(saved_text(file, lacks, picture_state_), long_note_seconds);
    } catch (InputError const& failure) {
        say(failure.what(), long_note_seconds);
    }
}

void Viewer::toggle_recording() {
    if (recorder_) {
        recorder_->stop(seconds_now() - recording_since_);
        return;
    }
    if (std::string lacks = picture_lacks(!picture_.rgba.empty()); !lacks.empty()) {
        say(std::move(lacks));
        return;
    }
    std::error_code error;
    recorder_.emplace(make_film_file(fs::current_path(error)));
    recording_since_ = seconds_now();
    recorder_->add(shown_picture(), 0);
    say("recording to " + recorder_->path().string(), long_note_seconds);
}

void Viewer::watch_recording() {
    if (recorder_ && recorder_->progress().is_done) {
        std::string const result = result_text(recorder_->progress(), recorder_->path());
        print_line("framelet-viewer", result);
        say(result, long_note_seconds);
        recorder_.reset();
    }
}

} // namespace framelet
