#include "server/render/surface/embree_filters.h"

#include <algorithm>

namespace framelet {
namespace {

/// The hits of one call, all of one geometry, that a filter may reject.
struct Candidates {
    RTCFilterFunctionNArguments const* args;

    Geometry const& geometry() const { return *static_cast<Geometry const*>(args->geometryUserPtr); }
    template <class Visit>
    void for_each_valid(Visit&& visit) const {
        for (unsigned i = 0; i < args->N; ++i) {
            if (args->valid[i] == -1) {
                visit(i, RTCHitN_primID(args->hit, args->N, i), RTCHitN_u(args->hit, args->N, i),
                      RTCHitN_v(args->hit, args->N, i));
            }
        }
    }
};

/// Copies hit `i` of the callback into `lane` of `hits`.
void keep_hit(RTCFilterFunctionNArguments const* args, unsigned i, int lane, HitPacket& hits) {
    hits.t[lane] = RTCRayN_tfar(args->ray, args->N, i);
    hits.u[lane] = RTCHitN_u(args->hit, args->N, i);
    hits.v[lane] = RTCHitN_v(args->hit, args->N, i);
    hits.triangle[lane] = RTCHitN_primID(args->hit, args->N, i);
    hits.geometry[lane] = RTCHitN_geomID(args->hit, args->N, i);
    hits.instance[lane] = RTCHitN_instID(args->hit, args->N, i, 0);
}

} // namespace

void reject_cut_out(RTCFilterFunctionNArguments const* args) {
    Candidates const candidates{args};
    Geometry const& geometry = candidates.geometry();
    candidates.for_each_valid([&](unsigned i, unsigned triangle, float u, float v) {
        if (alpha_at(geometry, triangle, u, v) < geometry.material->alpha_cutoff) {
            args->valid[i] = 0;
        }
    });
}

void reject_behind(RTCFilterFunctionNArguments const* args) {
    if (static_cast<Geometry const*>(args->geometryUserPtr)->material->double_sided) {
        return;
    }
    // Normal and ray are both in the mesh's own space, where front faces are counter-clockwise also if an instance
    // mirrors the mesh.
    for (unsigned i = 0; i < args->N; ++i) {
        float const along = RTCHitN_Ng_x(args->hit, args->N, i) * RTCRayN_dir_x(args->ray, args->N, i) +
                            RTCHitN_Ng_y(args->hit, args->N, i) * RTCRayN_dir_y(args->ray, args->N, i) +
                            RTCHitN_Ng_z(args->hit, args->N, i) * RTCRayN_dir_z(args->ray, args->N, i);
        if (args->valid[i] == -1 && along > 0) {
            args->valid[i] = 0;
        }
    }
}

void note_moving(RTCFilterFunctionNArguments const* args) {
    bool const see_through = static_cast<Geometry const*>(args->geometryUserPtr)->material->see_through();
    MovingHits& moving = *reinterpret_cast<QueryContext*>(args->context)->moving;
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) {
            continue;
        }
        bool const moves = moving.instances[RTCHitN_instID(args->hit, args->N, i, 0)].moves();
        args->valid[i] = see_through || moves ? 0 : -1;
        if (see_through || !moves) {
            continue;
        }
        int const lane = static_cast<int>(RTCRayN_id(args->ray, args->N, i));
        float const t = RTCRayN_tfar(args->ray, args->N, i);
        bool const met = (moving.met >> lane & 1) != 0;
        moving.met |= 1u << lane;
        if (!met || t < moving.nearest.t[lane]) {
            keep_hit(args, i, lane, moving.nearest);
        }
        if (!met || t > moving.farthest.t[lane]) {
            keep_hit(args, i, lane, moving.farthest);
        }
    }
}

void attenuate_shadow(RTCFilterFunctionNArguments const* args) {
    Candidates const candidates{args};
    Geometry const& geometry = candidates.geometry();
    LaneVec3& transmittance = *reinterpret_cast<QueryContext*>(args->context)->transmittance;
    candidates.for_each_valid([&](unsigned i, unsigned triangle, float u, float v) {
        int const lane = static_cast<int>(RTCRayN_id(args->ray, args->N, i));
        Vec3 const through = transmittance.get(lane) * transmittance_at(geometry, triangle, u, v);
        transmittance.set(lane, through);
        if (std::max({through.r, through.g, through.b}) > 1e-3f) {
            args->valid[i] = 0;
        }
    });
}

} // namespace framelet
