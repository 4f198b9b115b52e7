// Finds the file that a scene file names, by one rule for all formats: names are written for other systems, in other
// folders, by other programs. In: a name. Out: a file that there is and that the scene may read, or none.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "server/scene/reading/scene_folder.h"

namespace framelet {

struct NamedFile {
    std::filesystem::path file; ///< empty where there is none
    std::string remark; ///< where it is not quite what was named: one line that says so; else empty
};

/// Looks for the name as it is; then without blanks and quotes around it, with slashes for backslashes, by its last
/// part beside the scene, and each of these by other case or other Unicode composition. Never outside `folder`. The
/// remark says which `kind` ("image") is meant.
NamedFile find_named_file(SceneFolder const& folder, char const* kind, std::string_view name);

/// Why there is no such file: "image 'NAME' is missing", or that it lies outside.
std::string no_named_file(SceneFolder const& folder, char const* kind, std::string_view name);

} // namespace framelet
