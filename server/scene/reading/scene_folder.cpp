#include "server/scene/reading/scene_folder.h"

#include <algorithm>

namespace framelet {

SceneFolder::SceneFolder(std::filesystem::path const& scene_file, bool allow_outside)
    : path_(std::filesystem::absolute(scene_file).parent_path()), canonical_(std::filesystem::weakly_canonical(path_)),
      allow_outside_(allow_outside) {}

bool SceneFolder::note(std::filesystem::path const& file) const {
    if (asked_for_.size() < most_files) {
        asked_for_.insert(file);
    }
    return true;
}

bool SceneFolder::permits(std::filesystem::path const& file) const {
    if (allow_outside_) {
        return note(file);
    }
    std::error_code code;
    std::filesystem::path const canonical = std::filesystem::weakly_canonical(file, code);
    // Paths are compared part by part: /scenes/car2 does not lie in /scenes/car.
    auto const [rest, _] = std::mismatch(canonical_.begin(), canonical_.end(), canonical.begin(), canonical.end());
    return !code && rest == canonical_.end() && note(file);
}

} // namespace framelet
