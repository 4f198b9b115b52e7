// Summarises what is in a scene and what of its file was passed over, for people and for programs. In: a finished
// scene, the clips that play. Out: text, JSON.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "server/scene/scene.h"

namespace framelet {

/// Number of triangles that the scene shows: those of a mesh count for each node that has it.
std::size_t count_triangles(Scene const& scene);

/// The summary as lines for a terminal, the last one with its end of line.
std::string scene_summary_text(Scene const& scene, std::span<Index const> clips);

/// The summary as one JSON object.
std::string scene_summary_json(Scene const& scene, std::span<Index const> clips);

} // namespace framelet
