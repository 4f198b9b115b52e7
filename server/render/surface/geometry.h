// The things that the BVH's numbers stand for: triangle lists with their attributes, and meshes placed in the world.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/framelet/framelet_shape.h"
#include "server/render/surface/material.h"
#include "server/scene/motion/animation.h"

namespace framelet {

/// The other scene times by which motion is known: one before, three after the present one.
inline constexpr std::size_t motion_times = 4;

/// One Primitive as the renderer reads it, in its instance's own space. Where it deforms its positions live in the
/// BVH's own buffer.
struct Geometry {
    Primitive const* source = nullptr; ///< triangles, uv and colours
    RenderMaterial const* material = nullptr;
    std::span<Vec3 const> positions;
    std::span<Vec3 const> normals;
    std::span<Vec4 const> tangents; ///< empty where there are none
    /// Where the vertices are in the world at the other times of the scene (`MotionTimes`); empty where it does not
    /// deform.
    std::array<std::span<Vec3 const>, motion_times> elsewhen;
    std::span<BodyNumber const> bodies; ///< that carry the triangles, where the instance has no body of its own
};

/// Where something is placed in the world: linear * x + translation, metres.
struct WorldPlacement {
    Mat3 linear{1};
    Vec3 translation{0};

    Vec3 of(Vec3 const& x) const { return linear * x + translation; }
};

/// Opacity at a point of a triangle: base colour's alpha, map and vertex colour multiplied.
float alpha_at(Geometry const& geometry, std::uint32_t triangle, float u, float v);

/// Share of light that enters a transmissive surface from straight ahead: 4% are reflected.
inline constexpr float entering_share = 0.96f;

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
    bool flows = false; ///< its samples drift besides what their bodies do
    std::array<WorldPlacement, motion_times> elsewhen; ///< of what moves and does not deform, at the other times
    bool rolls = false; ///< turns fast as it goes, so that its outline goes with its origin

    /// True where it may be elsewhere soon: carried by a body, or deforming.
    bool moves() const { return body != static_body || flows; }
};

} // namespace framelet
