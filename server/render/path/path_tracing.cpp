#include "server/render/path/path_tracing.h"

#include "server/render/path/path_packet.h"

namespace framelet {

void trace_paths(PathScene const& scene, PathOptions const& options, RayPacket& rays, LaneMask active,
                 Footprint footprint, PathNumbers const& numbers, LaneVec3& radiance) {
    PathPacket(scene, options, rays, footprint, numbers, radiance).follow(active);
}

void gather_light(PathScene const& scene, PathOptions const& options, LaneVec3 const& position, LaneVec3 const& normal,
                  LaneMask active, Footprint footprint, PathNumbers const& numbers, GatheredLanes& out) {
    RayPacket rays{};
    LaneVec3 radiance;
    PathPacket(scene, options, rays, footprint, numbers, radiance).gather(position, normal, active, out);
    out.all = radiance;
}

} // namespace framelet
