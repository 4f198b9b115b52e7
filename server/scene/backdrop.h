// Finds the backdrop of a scene, which is there to be seen behind everything else and not to be looked at: a sky of
// triangles, and what stands about the rest far out, as hills do. In: boxes of the parts. Out: the box of what is left.
#pragma once

#include <vector>

#include "server/scene/motion/animation.h"

namespace framelet {

/// The box of all parts but the backdrop's. The backdrop is the fewest of the largest parts of which, from above, each
/// lies around all that are smaller, and the last has four times the ground of what is left, where the first is a sky.
/// A sky holds everything else and takes no light, as some of the rest does; or it is thirty times as large as what is
/// left. So the walls of a room are no backdrop, nor is a ground without a sky, and nothing is where all is one part.
Bounds without_backdrop(std::vector<ScenePart> parts);

} // namespace framelet
