// Checks and completes one primitive: finite numbers, right lengths, normals, tangents, normalised skin weights.
// In: a primitive as an importer made it, its material. Out: the primitive that scene.h promises, or an InputError.
#pragma once

#include "server/scene/scene.h"

namespace framelet {

/// Numbers of things that had to be repaired, for a warning.
struct PrimitiveRepairs {
    std::size_t normals = 0; ///< vertices whose normal was unusable
    std::size_t other = 0; ///< texture coordinates, colours and morph offsets that were not finite, or out of range
};

/// Finishes the primitive. Throws InputError, without the mesh's name, where its parts do not fit together or a
/// position is no usable number.
PrimitiveRepairs finish_primitive(Primitive& primitive, Material const& material);

} // namespace framelet
