// The cameras that the page looks through: those of the scene, bookmarks, and its own as a text.
#include <utility>

#include "client/core/camera/camera_text.h"
#include "client/core/present_moment.h"
#include "client/viewer/lacks.h"
#include "client/web/page_session.h"
#include "common/error.h"

namespace framelet {

void PageSession::choose_camera(int number) {
    if (number >= 0 && number < static_cast<int>(core_->welcome().cameras.size())) {
        scene_camera_ = number;
        is_at_bookmark_ = false;
    }
}

Camera PageSession::present_camera() const {
    return scene_camera_ >= 0 ? core_->shown_camera() : hand_->camera();
}

std::string PageSession::view() const {
    return camera_file_text(present_camera(), present_moment(*core_, settings_.exposure_ev),
                            core_->welcome().scene_origin);
}

void PageSession::go_to(std::string const& view) {
    CameraPath const path = parse_camera_path(view, "of the address");
    if (path.scene_camera >= 0) {
        choose_camera(path.scene_camera);
    } else {
        take_hand().set_camera(path.at(0, core_->welcome().scene_origin));
    }
    ViewerSettings wanted = settings_;
    wanted.exposure_ev = path.moment.exposure_ev.value_or(wanted.exposure_ev);
    set_settings(wanted);
    if (ClockRequest const clock = path.moment.clock_request(); clock.set != 0) {
        core_->request_clock(clock);
    }
}

CameraController& PageSession::take_hand() {
    if (scene_camera_ >= 0) {
        hand_->set_camera(core_->shown_camera());
        scene_camera_ = -1;
    }
    is_at_bookmark_ = false;
    return *hand_;
}

void PageSession::forget_bookmarks() {
    bookmarks_.clear();
    bookmark_ = -1;
    is_at_bookmark_ = false;
}

std::string PageSession::load_bookmarks(std::string const& text) {
    forget_bookmarks();
    try {
        bookmarks_ = parse_bookmarks(text, "of this browser", core_->welcome().scene_origin);
        return {};
    } catch (InputError const& error) {
        return std::string(error.what()) + "; bookmarks are left out";
    }
}

std::string PageSession::bookmarks() const {
    return bookmarks_text(bookmarks_, core_->welcome().scene_origin);
}

std::string PageSession::add_bookmark() {
    try {
        framelet::add_bookmark(bookmarks_, present_camera());
    } catch (InputError const& error) {
        return error.what();
    }
    bookmark_ = static_cast<int>(bookmarks_.size()) - 1;
    is_at_bookmark_ = scene_camera_ < 0;
    return bookmark_added_text(bookmarks_);
}

std::string PageSession::remove_bookmark() {
    if (std::string lacks = removal_lacks(bookmarks_.size(), bookmark_); !lacks.empty()) {
        return lacks;
    }
    auto const removed = bookmarks_.begin() + std::exchange(bookmark_, -1);
    std::string const name = removed->name;
    bookmarks_.erase(removed);
    is_at_bookmark_ = false;
    return bookmark_removed_text(name);
}

std::string PageSession::go_to_bookmark(int number) {
    if (std::string lacks = bookmark_lacks(bookmarks_.size(), number); !lacks.empty()) {
        return lacks;
    }
    Bookmark const& bookmark = bookmarks_[static_cast<std::size_t>(number)];
    take_hand().set_camera(bookmark.camera);
    bookmark_ = number;
    is_at_bookmark_ = true;
    return bookmark.name;
}

} // namespace framelet
