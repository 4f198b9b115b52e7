// Whether two scenes are the same, or of the same file, in a number. In: a scene. Out: a digest.
#pragma once

#include <cstdint>

#include "server/scene/scene.h"

namespace framelet {

/// The same for the same scene in every run of one build of this program, never 0; another one where names, triangles,
/// pictures, colours, poses or clips differ.
std::uint64_t scene_identity(Scene const& scene);

/// The same for the same file of the same machine, whatever is in it and whichever build of this program asks, and
/// never 0 then: what people keep for a scene outlives a change of it, and is not another folder's. 0 where the scene
/// is of no file.
std::uint64_t scene_source(Scene const& scene);

} // namespace framelet
