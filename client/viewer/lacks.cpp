#include "client/viewer/lacks.h"

#include "client/viewer/commands.h"
#include "common/counted.h"

namespace framelet {

namespace {

std::string samples_stay() {
    return with_keys("pixels are shown where they were rendered", Command::toggle_reprojection);
}

} // namespace

std::string clock_lacks(bool is_gone, bool moves, bool controls) {
    return is_gone     ? "the server is gone: its clock cannot be set"
           : !moves    ? nothing_moves_text
           : !controls ? watching_text
                       : "";
}

std::string scene_cameras_lack(std::size_t count) {
    return count == 0 ? "the scene has no cameras of its own" : "";
}

std::string bookmark_lacks(std::size_t count, int number) {
    return number >= 0 && static_cast<std::size_t>(number) < count ? ""
           : count == 0 ? with_keys("there are no bookmarks yet: add one", Command::add_bookmark)
                        : "there are only " + counted(count, "bookmark");
}

std::string removal_lacks(std::size_t count, int number) {
    return number >= 0 && static_cast<std::size_t>(number) < count
               ? ""
               : "no bookmark has been gone to: " + key_names(Command::bookmark) + " goes to the first";
}

std::string smoothing_lacks(bool moves, bool moves_samples) {
    return !moves ? nothing_moves_text : moves_samples ? "" : samples_stay();
}

std::string confidence_lacks(bool moves_samples) {
    return moves_samples ? "" : samples_stay() + ": ages say the same";
}

std::string clipboard_lacks(std::string const& text) {
    std::size_t const begin = text.find_first_not_of(" \t\r\n");
    return begin == std::string::npos || text[begin] != '{' ? "the clipboard holds no camera" : "";
}

std::string picture_lacks(bool has_picture) {
    return has_picture ? "" : "there is no picture yet";
}

} // namespace framelet
