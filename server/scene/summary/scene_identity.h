// Makes numbers by which to see whether two scenes are the same, or of the same file. In: a scene. Out: a digest.
#pragma once

#include <cstdint>

#include "server/scene/scene.h"

namespace framelet {

/// Digest of a scene's content: the same for the same scene in every run of one build of this program, never 0; another
/// one where names, triangles, pictures, colours, poses or clips differ.
std::uint64_t scene_identity(Scene const& scene);

/// Digest of a scene's file, or of its files in their order: the same for the same file of the same machine, whatever
/// is in it and whichever build of this program asks, and never 0 then. What people keep for a scene thus outlives a
/// change of it, and is not another folder's. 0 where the scene is of no file.
std::uint64_t scene_source(Scene const& scene);

} // namespace framelet
