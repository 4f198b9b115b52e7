// The last step of every import: checks a scene, completes and normalises it, so that nobody after has to doubt it.
// In: a Scene as an importer made it from a file. Out: what `import_scene` promises, or an InputError.
#pragma once

#include "server/scene/reading/import_budget.h"
#include "server/scene/reading/progress.h"
#include "server/scene/scene.h"

namespace framelet {

void finish_scene(Scene& scene, ImportBudget& budget, Progress const& progress);

} // namespace framelet
