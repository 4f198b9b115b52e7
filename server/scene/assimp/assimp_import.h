// Reads every format but glTF, through Assimp, into a Scene that still has to be finished (scene_finish.h).
// In: a path. Out: a Scene, or an InputError without the file's name.
#pragma once

#include <set>
#include <string>

#include "server/scene/reading/import_budget.h"
#include "server/scene/reading/progress.h"
#include "server/scene/reading/scene_folder.h"
#include "server/scene/scene.h"

namespace framelet {

/// Imports the file. Unless another process has read it before (`is_checked`, import_check.h), memory is limited for
/// the whole process while Assimp reads, so that nobody may be served meanwhile.
Scene import_assimp(std::filesystem::path const& file, SceneFolder const& folder, ImportBudget& budget,
                    Progress const& progress, bool is_checked);

/// The endings of files that Assimp reads, in lower case and with their dots.
std::set<std::string> assimp_endings();

} // namespace framelet
