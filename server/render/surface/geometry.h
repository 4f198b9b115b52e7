// The things that the BVH's numbers stand for: triangle lists with their attributes, and meshes placed in the world.
#pragma once

#include <span>
#include <vector>

#include "common/framelet/framelet_shape.h"
#include "server/render/surface/material.h"
#include "server/scene/motion/animation.h"

namespace framelet {

/// One Primitive as the renderer reads it, in its instance's own space. Its positions live in the BVH's own buffer.
struct Geometry {
    Primitive const* source = nullptr; ///< triangles, uv and colours
    RenderMaterial const* material = nullptr;
    std::span<Vec3> positions;
    std::span<Vec3 const> normals;
    std::span<Vec4 const> tangents; ///< empty where there are none
    std::span<Vec3 const> velocities; ///< of the vertices, world metres a second; empty where it does not deform
};

/// Opacity at a point of a triangle: base colour's alpha, map and vertex colour multiplied.
float alpha_at(Geometry const& geometry, std::uint32_t triangle, float u, float v);

/// Share of light that goes straight through a see-through surface, per colour.
Vec3 transmittance_at(Geometry const& geometry, std::uint32_t triangle, float u, float v);

/// A mesh in the world. Its transform is the identity for skinned meshes, whose vertices are in world space already.
struct Instance {
    std::span<Geometry const> geometries;
    Mat3 linear{1}; ///< world from the mesh's own space, before `translation`
    Vec3 translation{0}; ///< metres
    Mat3 normal_matrix{1}; ///< inverse transpose of `linear`
    float handedness = 1; ///< -1 where the transform mirrors: the winding then reads clockwise in the world
    BodyNumber body = static_body;
    bool flows = false; ///< its samples have velocities, of the vertices or of the transform
    Mat3 linear_rate{0}; ///< change of `linear` per second; set for bodies as well
    Vec3 translation_rate{0}; ///< metres a second
    bool spins = false; ///< turns so fast that none of its points goes straight on for long

    /// True where it may be elsewhere soon: carried by a body, or deforming.
    bool moves() const { return body != static_body || flows; }
};

} // namespace framelet
