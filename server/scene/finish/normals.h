// Makes vertex normals for primitives that come without, or with broken ones.
// In: a primitive whose triangles are in range. Out: unit normals, one a vertex.
#pragma once

#include "server/scene/scene.h"

namespace framelet {

/// Makes the shading flat, as glTF 2.0 section 3.7.2.1 asks for where a file has no normals: splits the vertices so
/// that no two triangles share one. Morph targets get the offsets that keep the morphed shape flat.
void make_flat_normals(Primitive& primitive);

/// Makes every normal unit length. Vertices whose normal is zero or not finite get the mean of their triangles',
/// weighted by angle. Returns how many vertices had to be repaired.
std::size_t repair_normals(Primitive& primitive);

} // namespace framelet
