// Whether two scenes are the same, in a number. In: a scene. Out: a digest.
#pragma once

#include <cstdint>

#include "server/scene/scene.h"

namespace framelet {

/// The same for the same scene in every run of one build of this program, never 0; another one where names, triangles,
/// pictures, colours, poses or clips differ.
std::uint64_t scene_identity(Scene const& scene);

} // namespace framelet
