// The last step of every import: checks a scene, completes and normalises it, so that nobody after has to doubt it.
// In: a Scene as an importer made it from a file. Out: what `import_scene` promises, or an InputError.
#pragma once

#include "server/scene/import_budget.h"
#include "server/scene/scene_import.h"

namespace framelet {

/// Largest coordinate that a vertex, a node or a key may have, metres: products of several stay finite in a float.
inline constexpr float max_coordinate = 1e9f;

void finish_scene(Scene& scene, ImportBudget& budget, Progress const& progress);

} // namespace framelet
