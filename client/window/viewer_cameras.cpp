// The cameras that a viewer looks through: those of the scene, bookmarks, and its own as a file.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "client/core/camera/axis_views.h"
#include "client/core/camera/camera_text.h"
#include "client/core/present_moment.h"
#include "client/viewer/commands.h"
#include "client/viewer/lacks.h"
#include "client/window/dropped_files.h"
#include "client/window/kept/user_files.h"
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
    leave_scene_camera();
    is_at_bookmark_ = false;
    auto const view = static_cast<std::size_t>(command) - static_cast<std::size_t>(Command::view_front);
    if (command == Command::toggle_projection) {
        controller_->toggle_projection();
        say(controller_->camera().projection == Projection::orthographic ? "orthographic" : "perspective");
        return;
    }
    AxisView const& along = axis_views[view];
    controller_->look_along(along.forward, along.up);
    controller_->fit(window_.framebuffer_size(), overlay_.covered_below());
    say(along.name);
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
        say(bookmark_added_text(bookmarks_->all()));
    });
}

void Viewer::remove_bookmark(int number) {
    if (std::string lacks = removal_lacks(bookmarks_->all().size(), number); !lacks.empty()) {
        say(std::move(lacks));
        return;
    }
    bookmark_ = -1;
    is_at_bookmark_ = false;
    std::string const name = bookmarks_->all()[static_cast<std::size_t>(number)].name;
    change_bookmarks([&] {
        bookmarks_->remove(static_cast<std::size_t>(number));
        say(bookmark_removed_text(name));
    });
}

void Viewer::go_to_bookmark(int number) {
    std::vector<Bookmark> const& all = bookmarks_->all();
    if (std::string lacks = bookmark_lacks(all.size(), number); !lacks.empty()) {
        say(std::move(lacks));
        return;
    }
    scene_camera_ = -1;
    bookmark_ = number;
    is_at_bookmark_ = true;
    controller_->set_camera(all[static_cast<std::size_t>(number)].camera);
    say(all[static_cast<std::size_t>(number)].name);
}

void Viewer::copy_camera(bool saves) {
    CameraMoment const moment = present_moment(*core_, settings_.exposure_ev);
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
