// Sixteen paths of light that are followed together, one a lane: what `trace_paths` and `gather_light` are made of. In:
// a scene, rays or places. Out: estimates of radiance.
#pragma once

#include <array>
#include <vector>

#include "server/render/path/lamps.h"
#include "server/render/path/path_tracing.h"
#include "server/render/path/scattering.h"
#include "server/render/surface/surface.h"

namespace framelet {

class PathPacket {
public:
    /// `footprint` is of the first rays, and scratch afterwards, as `rays` are. `radiance` is set for all lanes.
    PathPacket(PathScene const& scene, PathOptions const& options, RayPacket& rays, Footprint& footprint,
               PathNumbers const& numbers, LaneVec3& radiance);

    /// Follows the rays of `active` until all paths have ended.
    void follow(LaneMask active);
    /// Lets paths begin at white surfaces in these places. Light of lamps that comes straight from them is left out.
    void gather(LaneVec3 const& position, LaneVec3 const& normal, LaneMask active, GatheredLanes& out);

private:
    /// Pairs of random numbers that each step of a path takes.
    enum Pair : std::uint32_t {
        roulette,
        choices,
        lamp_point,
        light_point,
        sky_point,
        bounce,
        lobe,
        lamp_ray,
        lamp_way,
        lamp_aside,
        pairs
    };

    // path_packet.cpp: from surface to surface
    void follow_from(int step, LaneMask active);
    void add_sky(LaneMask missed);
    void add_emission(LaneMask present);
    void note_density(LaneMask present);
    LaneMask passes_behind(LaneMask culled) const;
    LaneMask choose_scattering(LaneMask present, LaneMask& passed);
    LaneMask add_known(LaneMask scattering);
    LaneMask bounce_on(LaneMask scattering);
    Geometry const& geometry_of(HitPacket const& hits, int i) const;
    Vec2 random(int i, Pair pair) const;
    void add(int i, Vec3 const& light, bool is_sky = false);
    void note_first(LaneMask active, LaneMask hit);

    // path_lights.cpp: rays to lights, and from lamps
    void add_met_lamps(LaneMask active, LaneMask hit);
    void add_sampled_lamps(LaneMask lit);
    void add_sampled_area_lights(LaneMask lit);
    void add_sampled_sky(LaneMask lit);
    void add_lit_by_lamps(LaneMask scattering);
    LaneMask find_lit_points(LaneMask lanes_lit);
    Vec3 light_of_lit_point(int i) const;
    void aim_shadow(int i, Vec3 const& direction, float distance, Vec3 const& light);
    void add_unshadowed(LaneMask lanes_lit, bool is_sky = false);
    bool above_facet(int i, Vec3 const& direction) const;
    float met_share(int i, float light_density) const;
    float found_share(float light_density, float surface_density) const;
    float lit_share(float found, Vec3 const& facet, std::uint32_t lamp, LampShine const& shine) const;

    bool bounced(int i) const { return (bounced_ >> i & 1) != 0; }

    PathScene const& paths_;
    PreparedScene const& scene_;
    PathOptions const& options_;
    RayPacket& rays_;
    Footprint& footprint_;
    PathNumbers const& numbers_;
    LaneVec3& radiance_;
    GatheredLanes* gathered_ = nullptr; ///< null: the paths do not begin at places
    int step_ = 0;
    LaneMask bounced_ = 0; ///< lanes whose ray comes from a surface
    LaneVec3 throughput_;
    LaneVec3 first_; ///< unit direction of the first ray of what is gathered
    LaneFloats density_; ///< of the last bounce's direction, 1 / sr
    LaneVec3 from_, from_normal_, from_facet_; ///< the point where the last bounce was
    LaneFloats found_, from_found_; ///< density with which bounces found the surface and that point, 1 / m^2
    HitPacket hits_{};
    SurfacePacket surfaces_{};
    std::array<Scattering, lanes> scattering_{};
    RayPacket shadow_{};
    LaneVec3 light_{}, transmittance_{};
    std::vector<LampShine> lamps_; ///< scratch
    std::array<LampRay, lanes> lamp_rays_{};
    HitPacket lit_hits_{}; ///< of these rays; `t`: distance from the surface
    LaneVec3 lit_points_{};
    SurfacePacket lit_{}; ///< as the surface sees it
};

} // namespace framelet
