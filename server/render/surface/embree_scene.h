// The two-level BVH. Everything that is drawn is an instance of a mesh. The only part that knows Embree (3.13 or 4).
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "server/render/packet.h"
#include "server/render/surface/geometry.h"

namespace framelet {

class EmbreeScene {
public:
    EmbreeScene();
    ~EmbreeScene();
    EmbreeScene(EmbreeScene const&) = delete;
    EmbreeScene& operator=(EmbreeScene const&) = delete;

    /// How what is added from now on is built.
    void build_as(BvhKind kind) { kind_ = kind; }
    /// Builds a BVH over the geometries, which must stay where they are, as must their sources. Sets their `positions`.
    /// `deforming`: built so that it can be refitted. `progress` is told what fraction is built, 0..1, from any thread,
    /// one at a time; where it throws, so does this, without a BVH.
    std::uint32_t add_mesh(std::span<Geometry> geometries, bool deforming,
                           std::function<void(double)> const& progress = {});
    // All that builds or moves throws std::bad_alloc where memory is missing, and from then on each time: Embree does
    // not say what it has left undone. Before anything is traced all has then to be cleared and added anew.

    /// True where memory was missing.
    bool is_broken() const;
    /// Removes all meshes and instances; those that are added next are numbered from 0.
    void clear();

    /// Positions of a geometry of a deforming mesh, to be written; empty where it has no triangles.
    std::span<Vec3> positions(std::uint32_t mesh, std::size_t geometry);
    /// Refits the mesh to positions that were written anew.
    void refit_mesh(std::uint32_t mesh);
    /// Instances are numbered from 0 in the order in which they are added. Until it is placed an instance is not there.
    std::uint32_t add_instance(std::uint32_t mesh);
    /// An instance that is not `present` vanishes. A transform that is present must be invertible with no element of
    /// its inverse above 1 / `least_instance_scale`, and move to where rays can start.
    void set_instance(std::uint32_t instance, Mat3 const& linear, Vec3 const& translation, bool present);
    /// Rebuilds the top level; needed after any of the above, before tracing.
    void commit();

    /// Says whether single-sided surfaces stop rays that meet them from behind.
    enum class Behind { stops, passes };

    /// Finds the nearest hit of each active lane between near and far; rays pass cut-outs. Returns the lanes that hit.
    /// `Behind::passes` costs a call for every candidate: meant for the few rays that met a surface from behind.
    LaneMask intersect(RayPacket const& rays, LaneMask active, Behind behind, HitPacket& hits) const;
    /// Returns the lanes whose segment meets something opaque; multiplies `transmittance` of the others by what
    /// see-through surfaces let pass.
    LaneMask occluded(RayPacket const& rays, LaneMask active, LaneVec3& transmittance) const;
    /// Finds the first and last opaque hit of each active lane among instances that move (`instances`: by number).
    /// Returns the lanes that have one, but for those whose segment meets something opaque that does not move. Costs a
    /// call for every surface on the way.
    LaneMask intersect_moving(RayPacket const& rays, LaneMask active, std::span<Instance const> instances,
                              HitPacket& nearest, HitPacket& farthest) const;

private:
    struct Handles;
    std::unique_ptr<Handles> handles_;
    BvhKind kind_ = BvhKind::fast;
};

} // namespace framelet
