// Parses the JSON of a glTF file within a budget. In: text. Out: the document, or an InputError.
#pragma once

#include <string_view>

#include "server/scene/gltf/gltf_json.h"
#include "server/scene/reading/import_budget.h"

namespace framelet {

/// The document without its `extras`, which may be large and say nothing of what there is to see; those of `asset` are
/// kept. Reserves memory for it and for what the importer makes of its objects. Throws InputError where the text is no
/// JSON, or not of a file of glTF 2.
Json parse_gltf_json(std::string_view text, ImportBudget& budget);

} // namespace framelet
