// Makes tangents for normal maps, in the manner of MikkTSpace ([Mikkelsen 2008]), which [glTF 2.0] asks for where a
// file has none. In: positions, normals, texture coordinates. Out: tangents.
#pragma once

#include <span>

#include "server/scene/scene.h"

namespace framelet {

/// Sets `tangents`: the direction of increasing u in the vertex's tangent plane, the mean over the triangles around it
/// weighted by their angle there; bitangent = w * cross(normal, tangent) points up the image: w is -1 where it is
/// mirrored. A vertex between mirrored and unmirrored triangles is split. Vertices alike in position, normal and
/// texture coordinate share a tangent even where the file holds them several times. `uv` has one entry a vertex: the
/// normal map's coordinates, transformed.
void make_tangents(Primitive& primitive, std::span<Vec2 const> uv);

/// Makes tangents of a file usable: unit length, w = +-1; broken ones get some direction in the tangent plane.
void repair_tangents(Primitive& primitive);

} // namespace framelet
