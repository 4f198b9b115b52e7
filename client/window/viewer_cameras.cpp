// The cameras that a viewer looks through: those of the scene, bookmarks, and its own as a file.
#include <filesystem>

#include "client/window/kept/user_files.h"
#include "client/window/overlay/key_table.h"
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
        say("free camera");
    }
}

void Viewer::take_view(Command command) {
    leave_scene_camera();
    is_at_bookmark_ = false;
    switch (command) { // glTF's scenes look towards +Z, and up is +Y
    case Command::view_front:
        controller_->look_along({0, 0, -1}, {0, 1, 0});
        say("from the front");
        break;
    case Command::view_right:
        controller_->look_along({-1, 0, 0}, {0, 1, 0});
        say("from the right");
        break;
    case Command::view_top:
        controller_->look_along({0, -1, 0}, {0, 0, -1});
        say("from above");
        break;
    default:
        controller_->toggle_projection();
        say(controller_->camera().projection == Projection::orthographic ? "orthographic" : "perspective");
    }
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
    try {
        std::string const text = camera_file_text(present_camera(), scene_origin_);
        if (!saves) {
            window_.set_clipboard(text);
            say("camera copied, as framelet-client --camera reads it");
            return;
        }
        std::error_code error;
        fs::path const file = new_file_name(fs::current_path(error), ".camera.json");
        write_user_file(file, text);
        say("saved " + file.string() + ", for framelet-client --camera", long_note_seconds);
    } catch (InputError const& failure) {
        say(failure.what(), long_note_seconds);
    }
}

} // namespace framelet
