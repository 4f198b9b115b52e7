// Tells whether a scene has anything that a viewer could ever see. In: a finished scene. Out: yes or no.
#pragma once

#include "server/scene/scene.h"

namespace framelet {

/// False where no node has a triangle with an area. A mesh that is skinned, morphed or moved may get one yet and
/// counts.
bool has_anything_to_see(Scene const& scene);

} // namespace framelet
