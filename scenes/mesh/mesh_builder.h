// Simple solids and surfaces with outward, unit normals. Metres; counter-clockwise from outside.
#pragma once

#include <functional>
#include <span>

#include "scenes/mesh/geometry.h"

namespace framelet {

/// A surface over the unit square: columns x rows quads, vertex (i, j) at surface(i / columns, j / rows); normals from
/// differences along the surface, outward when d/du x d/dv points outward. Texture coordinates are (u, v) * `repeats`.
/// Neighbouring quads share vertices. A square that collapses to a line keeps only its real triangle.
MeshData make_surface(int columns, int rows, std::function<D3(double u, double v)> const& surface, D2 repeats = {1, 1});

/// A box about the origin. Each face has texture coordinates of 1 a `texture_size` metres (0: once a face).
MeshData make_box(D3 size, double texture_size = 0);
/// A box whose edges are rounded with this radius.
MeshData make_rounded_box(D3 size, double radius);
/// A closed cylinder about the Y axis from y = 0 to `height`, with flat ends.
MeshData make_cylinder(double radius, double height, int segments);
/// A cone about the Y axis from y = 0 to `height`, no base.
MeshData make_cone(double radius, double height, int segments);
/// The curve (radius, height), turned about the Y axis; outward to the right of its direction of travel, so that a
/// curve that climbs is seen from outside. Corners sharper than 40 degrees stay sharp.
MeshData make_lathe(std::span<D2 const> curve, int segments);
/// A sphere about the origin: texture u runs eastward once round, v from the north pole (+Y) to the south.
MeshData make_sphere(double radius, int segments);
/// A torus about the Y axis.
MeshData make_torus(double major_radius, double minor_radius, int segments, int sides);
/// A rectangle in the XZ plane about the origin, facing +Y; texture coordinates of 1 a `texture_size` metres.
MeshData make_ground(D2 size, double texture_size);
/// An upright rectangle in the XY plane, lower edge at y = 0, facing +Z; the texture once over it.
MeshData make_card(D2 size);

/// Gives every vertex this colour.
void paint(MeshData& mesh, D3 color);

} // namespace framelet
