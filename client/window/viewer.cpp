#include "client/window/viewer.h"

#include <algorithm>
#include <utility>

#include "client/core/picture/display_timing.h"
#include "client/processes/end_signals.h"
#include "client/viewer/commands.h"
#include "client/viewer/lacks.h"
#include "client/window/kept/scene_memory.h"
#include "common/error.h"
#include "common/program_line.h"

namespace framelet {

namespace {

/// Time between two looks around while nothing happens: figures on the overlay, a note to take away. Seconds.
constexpr double idle_seconds = 0.25;

} // namespace

Viewer::Viewer(Window& window, Connection connection, OptionsFor options_for, SceneOpener& opener,
               DisplayChoice const& choice, std::optional<CameraPath> const& camera, ViewerMemory& memory,
               CanvasChoice painter)
    : window_(window), connection_(std::move(connection.options)), options_for_(std::move(options_for)),
      opener_(opener), memory_(memory), overlay_(window.handle()), chosen_exposure_(choice.exposure_ev),
      settings_(choice.settings()), lag_seconds_(choice.lag_seconds.value_or(memory.lag_seconds)),
      chosen_lag_seconds_(lag_seconds_ > 0 ? lag_seconds_ : usual_lag_seconds), painter_(std::move(painter)),
      steady_size_(window.framebuffer_size()), drawn_over_(choice.drawn_over) {
    settings_.bias = memory_.bias;
    adopt(std::move(connection.core));
    if (note_.empty()) {
        say("F1: help");
    }
    if (camera) {
        take_camera(*camera);
    }
    note_server();
}

void Viewer::note_server() {
    if (!opener_.has_open()) { // a private server will not be there next time
        memory_.note_server(connection_.server_name());
    }
}

double Viewer::seconds_now() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Viewer::adopt(std::unique_ptr<ClientCore> core) {
    bool const same_scene = core_ && core->welcome().scene_identity != 0 &&
                            core->welcome().scene_identity == core_->welcome().scene_identity;
    core_ = std::move(core);
    lost_.clear();
    meter_ = RateMeter();
    core_->set_smoothing(lag_seconds_);
    core_->set_drawn_over(drawn_over_);
    if (same_scene) {
        scene_number_ = core_->scene_number();
        core_->set_settings(settings_);
    } else {
        look_at_scene();
    }
}

/// Looks at the core's scene as one does at first. A scene of the same file is the same one after a change: the camera
/// stays where it is.
void Viewer::look_at_scene() {
    Welcome const welcome = core_->welcome();
    scene_number_ = core_->scene_number();
    bool const is_changed = controller_ && welcome.scene_name == scene_name_ && welcome.scene_source == scene_source_;
    std::optional<Camera> before = is_changed ? std::optional(controller_->camera()) : std::nullopt;
    if (before) {
        before->position += Vec3(scene_origin_ - welcome.scene_origin);
    }
    if (!bookmarks_ || !is_changed || scene_origin_ != welcome.scene_origin) {
        bookmarks_.emplace(bookmark_files(welcome.scene_name, welcome.scene_source), welcome.scene_origin);
        bookmark_ = -1;
        is_at_bookmark_ = false;
        if (!bookmarks_->complaint().empty()) {
            print_line("framelet-viewer", bookmarks_->complaint());
            say(bookmarks_->complaint(), long_note_seconds);
        }
        remember_exposure();
        settings_.exposure_ev = chosen_exposure_
                                    ? *chosen_exposure_
                                    : read_scene_memory(welcome.scene_name, welcome.scene_source).exposure_ev;
    }
    core_->set_settings(settings_);
    scene_name_ = welcome.scene_name;
    scene_source_ = welcome.scene_source;
    scene_origin_ = welcome.scene_origin;
    controller_.emplace(welcome.start_camera, welcome.scene_bounds);
    controller_->set_speed_factor(memory_.fly_speed);
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
    int overlay_frames = 0; ///< frames to be drawn for the overlay's sake
    OverlayContent shown;
    while (!quit_ && !is_told_to_end()) {
        bool const hidden = window_.is_hidden();
        if (hidden != settings_.paused) {
            settings_.paused = hidden;
            core_->set_settings(settings_);
            redraw = true;
        }
        double const idle = steady_size_.waits() ? SteadySize::rest_seconds : idle_seconds;
        WindowInput const input = window_.wait(pending && !hidden ? next_frame - seconds_now() : idle);
        double const now = seconds_now();
        moving = apply(input, moving ? now - last_look : 0);
        last_look = now;
        redraw = redraw || input.redraw;
        // A press of the mouse is seen in one frame, its release in the next, and what came of it in a third.
        overlay_frames = input.touched_overlay ? 3 : overlay_frames;
        take_dropped(input.dropped);
        watch_opener();
        watch_connection();
        watch_recording();
        if (lost_.empty()) {
            core_->set_view(controller_->camera(), steady_size_.update(window_.framebuffer_size(), now), scene_camera_);
        }
        pending = true;
        if (hidden || now < next_frame) {
            continue; // what has come is shown in the next display frame
        }
        redraw = update_shown_picture() || redraw;
        take_figures();
        OverlayContent content = overlay_content();
        redraw = redraw || moving || overlay_frames > 0 || content != shown;
        pending = redraw;
        if (redraw) {
            window_.draw_picture();
            OverlayActions const asked = overlay_.draw(content, window_.content_scale());
            window_.set_overlay_areas(overlay_.mouse_areas());
            window_.set_typing(overlay_.is_typed_into());
            apply(asked);
            meter_.frame(seconds_now() - now);
            window_.present();
            showing_.note(seconds_now() - made_);
            shown = std::move(content);
            // The next frame begins a little early: where the swap waits for the display, that sets the pace.
            next_frame = now + 0.9 / window_.refresh_rate();
            redraw = false;
            overlay_frames = std::max(overlay_frames - 1, 0);
        }
    }
    if (recorder_) {
        recorder_->stop(seconds_now() - recording_since_);
        recorder_->wait();
        watch_recording();
    }
    remember_exposure();
    return lost_.empty() || is_told_to_end() ? 0 : 1;
}

/// Keeps the exposure that was set by hand for the scene, if one was.
void Viewer::remember_exposure() {
    if (std::exchange(has_set_exposure_, false)) {
        write_scene_memory(scene_name_, scene_source_, {settings_.exposure_ev});
    }
}

/// Makes the picture on the graphics card, unless something is to be drawn over it in memory. Once that has failed the
/// processor paints.
bool Viewer::make_picture(Clock::time_point shown_at) {
    if (painter_.canvas && drawn_over_ == DrawnOver::nothing) {
        try {
            return core_->update_picture(picture_, changed_, shown_at, painter_.canvas.get());
        } catch (CanvasError const& error) {
            painter_ = processor_paints(error.what());
            is_on_canvas_ = false;
            print_line("framelet-viewer", painter_.complaint);
        }
    }
    return core_->update_picture(picture_, changed_, shown_at);
}

/// The last picture, in memory.
Picture const& Viewer::shown_picture() {
    if (is_on_canvas_) {
        painter_.canvas->read(picture_);
    }
    return picture_;
}

std::string Viewer::painter_text() const {
    if (!painter_.canvas || (drawn_over_ == DrawnOver::nothing && core_->statistics().lag_seconds == 0)) {
        return painter_.painter;
    }
    return drawn_over_ == DrawnOver::nothing ? "processor, for --smooth" : "processor, for what is drawn over (F3)";
}

/// Uploads what has changed; true when something has.
bool Viewer::update_shown_picture() {
    double const until_seen = core_->making_seconds() + showing_.expected();
    picture_state_ = core_->statistics().state(); // before: what comes meanwhile need not be in the picture
    bool const changed = make_picture(Clock::now() + DisplayTiming::duration(until_seen));
    made_ = seconds_now();
    if (changed) {
        is_on_canvas_ = core_->is_on_canvas();
        meter_.picture(core_->statistics().photon_seconds);
    }
    Viewport const size{picture_.width, picture_.height};
    bool const has_other_size = uploaded_size_ && *uploaded_size_ != size;
    if (old_picture_.is_better(has_other_size, has_other_size ? core_->statistics().coverage : 1, made_)) {
        return false;
    }
    bool const fades = core_->overlay_fades(); // it is drawn once more when it has faded
    bool const is_drawn_anew = (std::exchange(overlay_toggled_, fades) || fades) && !picture_.rgba.empty();
    if (!changed && !is_drawn_anew && !has_other_size) {
        return false;
    }
    bool const draws = drawn_over_ != DrawnOver::nothing;
    if (draws || is_drawn_anew) { // what is drawn ages everywhere
        changed_.assign(1, {0, 0, picture_.width, picture_.height});
    }
    if (draws) {
        overlaid_ = picture_;
        core_->draw_overlay(overlaid_);
    }
    if (is_on_canvas_) {
        window_.show_texture(painter_.canvas->texture(), painter_.canvas->size());
    } else {
        window_.upload(draws ? overlaid_ : picture_, changed_);
    }
    uploaded_size_ = size;
    if (recorder_ && (changed || has_other_size)) {
        recorder_->add(shown_picture(), made_ - recording_since_);
    }
    return true;
}

void Viewer::say(std::string note, double seconds) {
    note_ = std::move(note);
    note_until_ = seconds_now() + seconds;
}

/// Begins to connect to a server that the user has named.
void Viewer::try_server(NamedServer const& server) {
    try {
        attempts_.emplace(options_for_(server), true);
        opener_.give_up(); // the newest wish counts
    } catch (InputError const& error) {
        say(error.what(), long_note_seconds);
    }
}

void Viewer::watch_connection() {
    if (std::unique_ptr<ClientCore> core = attempts_ ? attempts_->poll() : nullptr) {
        if (attempts_->options().server != connection_.server) {
            opener_.close();
        }
        connection_ = attempts_->options();
        attempts_.reset();
        adopt(std::move(core));
        note_server();
    }
    if (lost_.empty()) {
        lost_ = opener_.end_reason();
        if (std::optional<std::string> reason = core_->end_reason(); reason && lost_.empty()) {
            lost_ = std::move(*reason);
        }
        if (!lost_.empty()) {
            print_line("framelet-viewer", lost_);
        }
    }
    std::optional<std::string> const interruption = core_->interruption();
    if (interruption && !interrupted_) {
        print_line("framelet-viewer", *interruption + "; trying to connect again");
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

/// Shows a scene that has been opened; where it cannot be opened, what is shown stays.
void Viewer::watch_opener() {
    if (std::optional<Connection> opened = opener_.poll()) {
        attempts_.reset();
        connection_ = opened->options;
        adopt(std::move(opened->core));
    }
    if (std::string const complaint = opener_.take_complaint(); !complaint.empty()) {
        print_line("framelet-viewer", complaint);
        say(complaint, long_note_seconds);
    }
}

/// Takes the figures of the overlay, also while nobody looks at them: plots show what was before.
void Viewer::take_figures() {
    ClientStatistics const statistics = core_->statistics();
    figures_.rows = figure_rows(statistics, time_line(), core_->controls());
    if (!meter_.update(seconds_now(), statistics.bytes) && !figures_.plots.empty()) {
        return;
    }
    history_.add(meter_, statistics);
    figures_.plots = history_.plots();
    figures_.details = detail_rows(statistics, meter_, window_.framebuffer_size(), painter_text());
}

TimeLine Viewer::time_line() const {
    return {core_->clock(), core_->welcome().animation_duration, clock_lacks(), settings_.exposure_ev};
}

CameraMenu Viewer::camera_menu(Welcome const& welcome) const {
    CameraMenu out;
    for (std::size_t i = 0; i < welcome.cameras.size(); ++i) {
        std::string const& own = welcome.cameras[i].name;
        out.scene_cameras.push_back(own.empty() ? "camera " + std::to_string(i + 1) : own);
    }
    for (Bookmark const& bookmark : bookmarks_->all()) {
        out.bookmarks.push_back(bookmark.name);
    }
    auto const name = [](std::vector<std::string> const& names, int number) {
        return number >= 0 && number < static_cast<int>(names.size()) ? names[static_cast<std::size_t>(number)]
                                                                      : std::string(free_camera_text);
    };
    out.current = scene_camera_ >= 0 ? name(out.scene_cameras, scene_camera_)
                                     : name(out.bookmarks, is_at_bookmark_ ? bookmark_ : -1);
    return out;
}

OverlayContent Viewer::overlay_content() {
    OverlayContent out;
    if (show_help_) {
        out.help = help_groups(clock_lacks());
    }
    if (memory_.shows_statistics) {
        out.statistics = figures_;
        out.statistics->shows_details = memory_.shows_details;
    }
    if (memory_.shows_bar) {
        Welcome const welcome = core_->welcome();
        out.time_line = time_line();
        out.cameras = camera_menu(welcome);
        out.bias = settings_.bias;
        out.overlays = {drawn_over_, confidence_lacks(settings_.reproject)};
        out.picture_lacks = picture_lacks(!picture_.rgba.empty());
    }
    // The core draws outlines instead where nothing is moved.
    bool const draws_ages = drawn_over_ == DrawnOver::confidence && !settings_.reproject;
    out.legend = legend_of(draws_ages ? DrawnOver::ages : drawn_over_);
    if (seconds_now() < note_until_) {
        out.note = note_;
    }
    opener_.show(out);
    out.has_pointer = !window_.has_mouse_look();
    out.sign = sign_text(
        {out.sign, interrupted_ && lost_.empty(), window_.has_mouse_look(),
         recorder_ ? with_keys(progress_text(recorder_->progress()), Command::toggle_recording) : std::string()});
    if (!lost_.empty()) {
        out.message = attempts_ ? attempts_->message() : lost_ + "\n\nR or Enter: connect again     Ctrl+Q: quit";
        out.asks_trust = attempts_ && attempts_->asks_trust();
    } else if (picture_.rgba.empty()) {
        out.message = "waiting for the first picture ...";
    }
    if (!lost_.empty() && !out.asks_trust) {
        out.address = {opener_.has_open() ? usual_server : connection_.server_name(), memory_.servers,
                       attempts_ ? attempts_->field_at_fault() : ServerField::none};
    }
    return out;
}

} // namespace framelet
