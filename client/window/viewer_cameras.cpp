// The cameras that a viewer looks through: those of the scene, bookmarks, and its own as a file.
#include <algorithm>
#include <filesystem>
#include <iterator>

#include "client/window/dropped_files.h"
#include "client/window/kept/user_files.h"
#include "client/window/overlay/commands.h"
#include "client/window/overlay/lacks.h"
#include "client/window/viewer.h"
#include "common/counted.h"
#include "common/error.h"

namespace framelet {

namespace fs = std::filesystem;

void Viewer::choose_scene_camera(int number) {
    std::vector<SceneCameraInfo> const cameras = core_->welcome().cameras;
    if (number >= static_cast<int>(cameras.size())) {
        std::string const lacks = scene_cameras_lack(cameras.size());
        say(lacks.empty() ? "the scene has only " + counted(cameras.size(), "camera") : lacks);
        return;
    }
    scene_camera_ = number;
    is_at_bookmark_ = false;
    std::string const& name = cameras[static_cast<std::size_t>(number)].name;
    say("camera " + std::to_string(number + 1) + (name.empty() ? "" : ": " + name));
}

void Viewer::leave_scene_camera() {
    if (scene_camera_ >= 0) {
        scene_camera_ = -1;
        controller_->set_camera(core_->shown_camera());
        say(free_camera_text);
    }
}

void Viewer::take_view(Command command) {
    struct AxisView {
        Command command;
        Vec3 forward, up;
        char const* name;
    };
    // glTF's scenes look towards +Z, and up is +Y.
    static constexpr AxisView views[] = {
        {Command::view_front, {0, 0, -1}, {0, 1, 0}, "from the front"},
        {Command::view_back, {0, 0, 1}, {0, 1, 0}, "from behind"},
        {Command::view_right, {-1, 0, 0}, {0, 1, 0}, "from the right"},
        {Command::view_left, {1, 0, 0}, {0, 1, 0}, "from the left"},
        {Command::view_top, {0, -1, 0}, {0, 0, -1}, "from above"},
        {Command::view_below, {0, 1, 0}, {0, 0, 1}, "from below"},
    };
    leave_scene_camera();
    is_at_bookmark_ = false;
    auto const* const view = std::ranges::find(views, command, &AxisView::command);
    if (view == std::end(views)) {
        controller_->toggle_projection();
        say(controller_->camera().projection == Projection::orthographic ? "orthographic" : "perspective");
        return;
    }
    controller_->look_along(view->forward, view->up);
    controller_->fit(window_.framebuffer_size(), overlay_.covered_below());
    say(view->name);
}

Camera Viewer::present_camera() const {
    return scene_camera_ >= 0 ? core_->shown_camera() : controller_->camera();
}

/// Changes the bookmarks; says why not where that fails.
void Viewer::change_bookmarks(std::function<void()> const& change) {
    try {
        change();
    } catch (InputError const& error) {
        say(error.what(), long_note_seconds);
    }
}

void Viewer::add_bookmark() {
    change_bookmarks([this] {
        std::size_t const before = bookmarks_->all().size();
        try {
            bookmarks_->add(present_camera());
        } catch (InputError const&) {
            bookmark_ = bookmarks_->all().size() > before ? static_cast<int>(before) : bookmark_;
            throw;
        }
        bookmark_ = static_cast<int>(before);
        is_at_bookmark_ = scene_camera_ < 0;
        say("bookmark " + bookmarks_->all().back().name + " added" +
            (bookmark_ < numbered_cameras
                 ? ": " + key_names(numbered(Command::bookmark, bookmark_)) + " comes back here"
                 : ""));
    });
}

void Viewer::remove_bookmark(int number) {
    if (number < 0 || number >= static_cast<int>(bookmarks_->all().size())) {
        say("no bookmark has been gone to: " + key_names(Command::bookmark) + " goes to the first");
        return;
    }
    bookmark_ = -1;
    is_at_bookmark_ = false;
    std::string const name = bookmarks_->all()[static_cast<std::size_t>(number)].name;
    change_bookmarks([&] {
        bookmarks_->remove(static_cast<std::size_t>(number));
        say("bookmark " + name + " removed");
    });
}

void Viewer::go_to_bookmark(int number) {
    std::vector<Bookmark> const& all = bookmarks_->all();
    if (number >= static_cast<int>(all.size())) {
        say(all.empty() ? with_keys("there are no bookmarks yet: add one", Command::add_bookmark)
                        : "there are only " + counted(all.size(), "bookmark"));
        return;
    }
    scene_camera_ = -1;
    bookmark_ = number;
    is_at_bookmark_ = true;
    controller_->set_camera(all[static_cast<std::size_t>(number)].camera);
    say(all[static_cast<std::size_t>(number)].name);
}

void Viewer::copy_camera(bool saves) {
    CameraMoment moment;
    if (core_->welcome().animation_duration > 0) {
        ClockState const clock = core_->clock();
        moment.scene_time = std::max(clock.time - core_->statistics().lag_seconds, 0.0);
        moment.paused = !clock.playing;
    }
    moment.exposure_ev = settings_.exposure_ev;
    std::string const text = camera_file_text(present_camera(), moment, scene_origin_);
    if (!saves) {
        window_.set_clipboard(text);
        say("view copied: " + key_names(Command::paste_camera) + " goes to it, --camera reads it");
        return;
    }
    try {
        std::error_code error;
        fs::path const file = new_file_name(fs::current_path(error), ".camera.json");
        write_user_file(file, text);
        say("saved " + file.string() + ", for --camera, or to be dropped here", long_note_seconds);
    } catch (InputError const& failure) {
        say(failure.what(), long_note_seconds);
    }
}

void Viewer::paste_camera() {
    std::string const text = window_.clipboard();
    if (std::string lacks = clipboard_lacks(text); !lacks.empty()) {
        say(std::move(lacks));
        return;
    }
    try {
        take_camera(parse_camera_path(text, "of the clipboard"));
    } catch (InputError const& failure) {
        say(failure.what(), long_note_seconds);
    }
}

/// Looks from where a file says, at the moment and with the exposure that it says. Of a flight that is its beginning.
void Viewer::take_camera(CameraPath const& path) {
    say("the view that was given");
    is_at_bookmark_ = false;
    if (path.scene_camera >= 0) {
        choose_scene_camera(path.scene_camera);
    } else {
        scene_camera_ = -1;
        controller_->set_camera(path.at(0, scene_origin_));
    }
    settings_.exposure_ev = path.moment.exposure_ev.value_or(settings_.exposure_ev);
    core_->set_settings(settings_);
    ClockRequest const clock = path.moment.clock_request();
    if (clock.set == 0) {
        return;
    }
    if (std::string const lacks = clock_lacks(); !lacks.empty()) {
        say("the view that was given, not its moment: " + lacks, long_note_seconds);
        return;
    }
    core_->request_clock(clock);
}

/// Takes the last of the cameras among the files, and opens the scenes.
void Viewer::take_dropped(std::vector<std::string> const& files) {
    DroppedFiles const dropped = sort_dropped(files);
    opener_.open(dropped.scenes);
    if (dropped.cameras.empty()) {
        return;
    }
    try {
        take_camera(read_camera_path(dropped.cameras.back()));
    } catch (InputError const& failure) {
        say(failure.what(), long_note_seconds);
    }
}

} // namespace framelet
