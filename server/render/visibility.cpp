#include "server/render/visibility.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "server/render/flush_denormals.h"
#include "server/render/prepared/prepared_scene.h"
#include "server/render/surface/surface.h"
#include "server/render/view_packet.h"

namespace framelet {
namespace {

/// Number of rays along a side of a packet.
constexpr int packet_side = 4;
static_assert(packet_side * packet_side == lanes);

/// Traces 4x4 neighbouring rays; gives their inverse depths.
template <class Position>
void look(PreparedScene const& scene, ViewRays const& view, Position&& position, LaneFloats& inverse_depth) {
    RayPacket const rays = rays_through(view, position);
    HitPacket hits{};
    LaneMask const hit = scene.bvh.intersect(rays, all_lanes, EmbreeScene::Behind::stops, hits);
    inverse_depth.fill(0);
    if (hit == 0) {
        return;
    }
    Footprint footprint;
    footprint.width.fill(0);
    footprint.slope.fill(0);
    SurfacePacket surfaces{};
    LaneMask const present = make_surfaces(scene.instances, rays, hits, hit, footprint, surfaces);
    for_each_lane(hit, [&](int i) {
        Geometry const& geometry = scene.instances[hits.instance[i]].geometries[hits.geometry[i]];
        bool const is_known = (present >> i & 1) != 0 && !geometry.material->see_through();
        inverse_depth[i] = is_known ? 1 / hits.t[i] : unknown_inverse_depth;
    });
}

} // namespace

std::uint64_t render_visibility(RenderScene const& scene, ViewRays const& view, Viewport viewport, RayGrid const& grid,
                                std::vector<float>& inverse_depth) {
    int const columns = grid.columns(viewport);
    int const rows = grid.rows(viewport);
    inverse_depth.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    tbb::parallel_for(0, (rows + packet_side - 1) / packet_side, [&](int band) {
        FlushDenormals const flush;
        int const top = band * packet_side;
        for (int left = 0; left < columns; left += packet_side) {
            // Unused lanes of the last packets repeat their last positions.
            auto const column_of = [&](int i) { return std::min(left + i % packet_side, columns - 1); };
            auto const row_of = [&](int i) { return std::min(top + i / packet_side, rows - 1); };
            LaneFloats found;
            look(
                scene.prepared(), view, [&](int i) { return grid.position(column_of(i), row_of(i)); }, found);
            for (int i = 0; i < lanes; ++i) {
                inverse_depth[static_cast<std::size_t>(row_of(i)) * static_cast<std::size_t>(columns) +
                              static_cast<std::size_t>(column_of(i))] = found[i];
            }
        }
    });
    return inverse_depth.size();
}

} // namespace framelet
