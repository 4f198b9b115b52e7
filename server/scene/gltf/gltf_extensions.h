// Says which extensions of glTF the importer reads, and what is missing of a file that uses others.
// In: a file's JSON. Out: a line for each.
#pragma once

#include <string>
#include <vector>

#include "server/scene/gltf/gltf_json.h"

namespace framelet {

/// Adds a line to `remarks` for each extension that the file uses and the importer does not read. Returns a phrase that
/// names those which the file requires; an empty one where there are none.
std::string note_extensions(Json const& json, std::vector<std::string>& remarks);

} // namespace framelet
