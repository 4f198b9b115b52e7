// Finds the scene files in a folder. In: the folder. Out: their paths.
#pragma once

#include <filesystem>
#include <vector>

namespace framelet {

/// The files right in the folder whose names end as those of a format that `import_scene` reads, in the order of their
/// names; nothing of them is read. Throws InputError where the folder cannot be read.
std::vector<std::filesystem::path> scene_files_in(std::filesystem::path const& folder);

} // namespace framelet
