// Keeps what lies far from the origin of its file (coordinates of maps, of buildings) as exact as what lies near it:
// single precision has steps of 0.3 m at 4000 km. In and out: a finished Scene.
#pragma once

#include "server/scene/scene.h"

namespace framelet {

/// Sets the scene's origin: (0, 0, 0) where what it shows at time 0 is about there for its size, else a point amid it
/// with round coordinates, which stays the same where the scene changes a little.
void set_origin(Scene& scene);

/// Moves vertices that lie far from their mesh's origin, for the size of the scene, to it. The nodes of such a mesh get
/// a child there that has it in their place.
void centre_meshes(Scene& scene);

/// The point that stands for a box: (0, 0, 0) where that is not far from it for its size (or `least_size`, if that is
/// more), else a point within the box's size of its centre, with round coordinates.
glm::dvec3 round_centre(glm::dvec3 const& lower, glm::dvec3 const& upper, double least_size = 0);

} // namespace framelet
