// Small operations on a primitive's vertex attributes, all of them at once.
// In and out: Primitive values. Used while importing only.
#pragma once

#include <span>

#include "server/scene/scene.h"

namespace framelet {

/// A primitive with the vertices that `source` names, in that order, of all attributes and morph targets; the same
/// material, no triangles. Every index of `source` must be in range.
Primitive gather_vertices(Primitive const& primitive, std::span<std::uint32_t const> source);

/// Memory that a vertex of the primitive takes, all attributes and morph targets together.
std::size_t bytes_per_vertex(Primitive const& primitive);

/// Removes the vertices that no triangle uses (files often let many primitives share one large vertex array).
void drop_unused_vertices(Primitive& primitive);

} // namespace framelet
