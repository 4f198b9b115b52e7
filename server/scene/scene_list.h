// Finds the scene files below a folder. In: the folder. Out: their paths.
#pragma once

#include <filesystem>
#include <vector>

namespace framelet {

/// The files in the folder and in those below it whose names end as those of a format that `import_scene` reads, in the
/// order of their paths; nothing of them is read. Folders that are hidden, may not be read or are links are passed
/// over. Throws InputError where the folder cannot be read.
std::vector<std::filesystem::path> scene_files_in(std::filesystem::path const& folder);

} // namespace framelet
