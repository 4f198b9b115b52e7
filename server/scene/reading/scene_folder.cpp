#include "server/scene/reading/scene_folder.h"

#include <algorithm>
#include <utility>

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

bool SceneFolder::has(std::filesystem::path const& canonical) const {
    // Paths are compared part by part: /scenes/car2 does not lie in /scenes/car.
    auto const [rest, _] = std::mismatch(canonical_.begin(), canonical_.end(), canonical.begin(), canonical.end());
    return rest == canonical_.end();
}

bool SceneFolder::permits(std::filesystem::path const& file) const {
    std::error_code code;
    return (allow_outside_ || (has(std::filesystem::weakly_canonical(file, code)) && !code)) && note(file);
}

std::optional<RegularFile> SceneFolder::open(std::filesystem::path const& file) const {
    RegularFile opened(file);
    bool const may_be_read = opened && (allow_outside_ || has(opened.canonical()));
    return may_be_read ? std::optional(std::move(opened)) : std::nullopt;
}

} // namespace framelet
