#include "server/render/surface/embree_scene.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>
#include <type_traits>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "common/error.h"

namespace framelet {
namespace {

#if RTC_VERSION_MAJOR >= 4
using Context = RTCRayQueryContext;
#else
using Context = RTCIntersectContext;
#endif

/// Lets a query bring a filter of its own.
#if RTC_VERSION_MAJOR >= 4
constexpr RTCSceneFlags query_filters = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
constexpr RTCSceneFlags query_filters = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

/// What a query finds of instances that move.
struct MovingHits {
    std::span<Instance const> instances;
    HitPacket& nearest;
    HitPacket& farthest;
    LaneMask met = 0;
};

/// Handed through Embree to the filters; the context must stand first.
struct QueryContext {
    Context embree;
    LaneVec3* transmittance = nullptr;
    MovingHits* moving = nullptr;
};

/// Scenes this small have one top level, whatever moves in them.
constexpr std::size_t few_instances = 256;

/// The top levels to be traced; the second may not be there.
struct Levels {
    RTCScene first, second;

    template <class Visit>
    void for_each(Visit&& visit) const {
        visit(first);
        if (second) {
            visit(second);
        }
    }
};

struct Handle {
    RTCScene scene;
    std::vector<RTCGeometry> geometries;
};

/// A hit that a filter may reject, by its lane in the callback.
struct Candidate {
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

void reject_cut_out(RTCFilterFunctionNArguments const* args) {
    Candidate const candidate{args};
    Geometry const& geometry = candidate.geometry();
    candidate.for_each_valid([&](unsigned i, unsigned triangle, float u, float v) {
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

/// `i`: of the callback.
void keep_hit(RTCFilterFunctionNArguments const* args, unsigned i, int lane, HitPacket& hits) {
    hits.t[lane] = RTCRayN_tfar(args->ray, args->N, i);
    hits.u[lane] = RTCHitN_u(args->hit, args->N, i);
    hits.v[lane] = RTCHitN_v(args->hit, args->N, i);
    hits.triangle[lane] = RTCHitN_primID(args->hit, args->N, i);
    hits.geometry[lane] = RTCHitN_geomID(args->hit, args->N, i);
    hits.instance[lane] = RTCHitN_instID(args->hit, args->N, i, 0);
}

/// Nothing that moves stops a ray, nor does what lets light through; the first and the last that move are kept.
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
    Candidate const candidate{args};
    Geometry const& geometry = candidate.geometry();
    LaneVec3& transmittance = *reinterpret_cast<QueryContext*>(args->context)->transmittance;
    candidate.for_each_valid([&](unsigned i, unsigned triangle, float u, float v) {
        int const lane = static_cast<int>(RTCRayN_id(args->ray, args->N, i));
        Vec3 const through = transmittance.get(lane) * transmittance_at(geometry, triangle, u, v);
        transmittance.set(lane, through);
        if (std::max({through.r, through.g, through.b}) > 1e-3f) {
            args->valid[i] = 0;
        }
    });
}

/// Copies `count` lanes from `first` on into Embree's layout of that many.
template <class RayN, int count>
void load_rays(RayPacket const& rays, int first, RayN& out) {
    constexpr std::size_t bytes = sizeof(float) * count;
    std::memcpy(out.org_x, rays.origin.x.lane + first, bytes);
    std::memcpy(out.org_y, rays.origin.y.lane + first, bytes);
    std::memcpy(out.org_z, rays.origin.z.lane + first, bytes);
    std::memcpy(out.dir_x, rays.direction.x.lane + first, bytes);
    std::memcpy(out.dir_y, rays.direction.y.lane + first, bytes);
    std::memcpy(out.dir_z, rays.direction.z.lane + first, bytes);
    std::memcpy(out.tnear, rays.near.lane + first, bytes);
    std::memcpy(out.tfar, rays.far.lane + first, bytes);
    for (int i = 0; i < count; ++i) {
        out.time[i] = 0;
        out.mask[i] = ~0u;
        out.id[i] = static_cast<unsigned>(first + i);
        out.flags[i] = 0;
    }
}

/// Rays that Embree cannot trace (it checks, and aborts the process) are not handed to it: they meet nothing.
template <int count>
bool valid_lanes(RayPacket const& rays, LaneMask active, int first, int* valid) {
    if (((active >> first) & ((1u << count) - 1)) == 0) {
        return false;
    }
    for (int i = 0; i < count; ++i) {
        int const lane = first + i;
        bool const wanted = (active >> lane & 1) != 0;
        valid[i] = -(int{wanted} & int{traceable(rays.origin.get(lane))} & int{traceable(rays.direction.get(lane))});
    }
    return true;
}

/// Without a `filter` of the query's own, rays are taken to be coherent.
template <int count>
LaneMask intersect_lanes(Levels const& levels, RayPacket const& rays, LaneMask active, int first,
                         RTCFilterFunctionN filter, MovingHits* moving, HitPacket& hits) {
    alignas(64) int valid[count];
    if (!valid_lanes<count>(rays, active, first, valid)) {
        return 0;
    }
    std::conditional_t<count == 16, RTCRayHit16, RTCRayHit8> query;
    load_rays<decltype(query.ray), count>(rays, first, query.ray);
    for (int i = 0; i < count; ++i) {
        query.hit.u[i] = query.hit.v[i] = 0;
        query.hit.primID[i] = 0;
        query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    QueryContext context;
    context.moving = moving;
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&context.embree);
    RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.context = &context.embree;
    args.flags = filter ? RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER : RTC_RAY_QUERY_FLAG_COHERENT;
    args.filter = filter;
    levels.for_each([&](RTCScene scene) {
        if constexpr (count == 16) {
            rtcIntersect16(valid, scene, &query, &args);
        } else {
            rtcIntersect8(valid, scene, &query, &args);
        }
    });
#else
    rtcInitIntersectContext(&context.embree);
    context.embree.flags = filter ? RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT : RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    context.embree.filter = filter;
    levels.for_each([&](RTCScene scene) { // the second one only finds what is nearer
        if constexpr (count == 16) {
            rtcIntersect16(valid, scene, &context.embree, &query);
        } else {
            rtcIntersect8(valid, scene, &context.embree, &query);
        }
    });
#endif
    LaneMask hit = 0;
    for (int i = 0; i < count; ++i) {
        hits.t[first + i] = query.ray.tfar[i];
        hits.u[first + i] = query.hit.u[i];
        hits.v[first + i] = query.hit.v[i];
        hits.triangle[first + i] = query.hit.primID[i];
        hits.geometry[first + i] = query.hit.geomID[i];
        hits.instance[first + i] = query.hit.instID[0][i];
        bool const met = valid[i] != 0 && query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        hit |= static_cast<LaneMask>(met ? 1u : 0u) << (first + i);
    }
    return hit;
}

template <int count>
LaneMask occluded_lanes(Levels const& levels, RayPacket const& rays, LaneMask active, int first,
                        LaneVec3& transmittance) {
    alignas(64) int valid[count];
    if (!valid_lanes<count>(rays, active, first, valid)) {
        return 0;
    }
    std::conditional_t<count == 16, RTCRay16, RTCRay8> query;
    load_rays<decltype(query), count>(rays, first, query);
    QueryContext context;
    context.transmittance = &transmittance;
    LaneMask blocked = 0;
    auto leave_out_blocked = [&] {
        for (int i = 0; i < count; ++i) {
            bool const met = valid[i] != 0 && query.tfar[i] < 0; // -infinity marks a hit
            blocked |= static_cast<LaneMask>(met ? 1u : 0u) << (first + i);
            valid[i] = met ? 0 : valid[i];
        }
    };
    // Embree 3's 16-wide coherent occlusion was seen not to return on instanced scenes under AVX-512.
    constexpr bool coherent = count != 16;
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&context.embree);
    RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.context = &context.embree;
    args.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    levels.for_each([&](RTCScene scene) {
        leave_out_blocked();
        if constexpr (count == 16) {
            rtcOccluded16(valid, scene, &query, &args);
        } else {
            rtcOccluded8(valid, scene, &query, &args);
        }
    });
#else
    rtcInitIntersectContext(&context.embree);
    context.embree.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    levels.for_each([&](RTCScene scene) {
        leave_out_blocked();
        if constexpr (count == 16) {
            rtcOccluded16(valid, scene, &context.embree, &query);
        } else {
            rtcOccluded8(valid, scene, &context.embree, &query);
        }
    });
#endif
    leave_out_blocked();
    return blocked;
}

void report(void*, RTCError code, char const* message) {
    std::fprintf(stderr, "Embree error %d: %s\n", static_cast<int>(code), message ? message : "");
}

} // namespace

struct EmbreeScene::Handles {
    /// One of the two top levels.
    struct Level {
        RTCScene scene = nullptr;
        std::size_t count = 0;
        bool changed = true;
    };
    struct Placed {
        RTCGeometry geometry;
        bool moves;
    };

    RTCDevice device = nullptr;
    bool sixteen_wide = false;
    std::vector<Handle> meshes;
    std::vector<Placed> instances;
    /// Where many instances stand still and few move, the two kinds have a level each: rebuilding one of thousands of
    /// instances takes milliseconds, tracing a second small one nanoseconds.
    Level still, moving;
    bool settled = false; ///< committed once: what is placed again from now on moves
    bool broken = false; ///< memory was missing: Embree may have left half of something, and is not asked again

    Level& level_of(Placed const& instance) { return instance.moves ? moving : still; }

    /// After what takes memory; before it as well, so that nothing follows what has failed.
    void throw_failure() {
        RTCError const error = rtcGetDeviceError(device);
        broken = broken || error == RTC_ERROR_OUT_OF_MEMORY || error == RTC_ERROR_UNKNOWN;
        if (broken) {
            throw std::bad_alloc();
        }
    }
};

EmbreeScene::EmbreeScene() : handles_(std::make_unique<Handles>()) {
    handles_->device = rtcNewDevice(nullptr);
    FRAMELET_CHECK(handles_->device != nullptr);
    rtcSetDeviceErrorFunction(handles_->device, report, nullptr);
    handles_->sixteen_wide = rtcGetDeviceProperty(handles_->device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
    for (Handles::Level* level : {&handles_->still, &handles_->moving}) {
        level->scene = rtcNewScene(handles_->device);
        rtcSetSceneFlags(level->scene, query_filters);
        rtcCommitScene(level->scene);
    }
}

EmbreeScene::~EmbreeScene() {
    for (Handles::Placed const& instance : handles_->instances) {
        rtcReleaseGeometry(instance.geometry);
    }
    rtcReleaseScene(handles_->still.scene);
    rtcReleaseScene(handles_->moving.scene);
    for (Handle const& mesh : handles_->meshes) {
        for (RTCGeometry const geometry : mesh.geometries) {
            rtcReleaseGeometry(geometry);
        }
        rtcReleaseScene(mesh.scene);
    }
    rtcReleaseDevice(handles_->device);
}

std::uint32_t EmbreeScene::add_mesh(std::span<Geometry> geometries, bool deforming) {
    Handle mesh{rtcNewScene(handles_->device), {}};
    rtcSetSceneFlags(mesh.scene, deforming ? query_filters | RTC_SCENE_FLAG_DYNAMIC : query_filters);
    for (std::size_t i = 0; i < geometries.size(); ++i) {
        Geometry& geometry = geometries[i];
        Primitive const& source = *geometry.source;
        RTCGeometry const handle = rtcNewGeometry(handles_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        mesh.geometries.push_back(handle);
        if (source.positions.empty() || source.triangles.empty()) {
            continue; // a geometry that is not attached keeps the numbers of the others
        }
        void* const vertices = rtcSetNewGeometryBuffer(handle, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                       sizeof(Vec3), source.positions.size());
        handles_->throw_failure();
        FRAMELET_CHECK(vertices != nullptr);
        std::memcpy(vertices, source.positions.data(), source.positions.size() * sizeof(Vec3));
        geometry.positions = {static_cast<Vec3*>(vertices), source.positions.size()};
        rtcSetSharedGeometryBuffer(handle, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, source.triangles.data(), 0,
                                   sizeof(source.triangles[0]), source.triangles.size());
        if (deforming) {
            rtcSetGeometryBuildQuality(handle, RTC_BUILD_QUALITY_REFIT);
        }
        rtcSetGeometryUserData(handle, &geometry);
        if (geometry.material->alpha_mode == AlphaMode::mask) {
            rtcSetGeometryIntersectFilterFunction(handle, reject_cut_out);
            rtcSetGeometryOccludedFilterFunction(handle, reject_cut_out);
        }
        if (geometry.material->see_through()) {
            rtcSetGeometryOccludedFilterFunction(handle, attenuate_shadow);
        }
        rtcCommitGeometry(handle);
        rtcAttachGeometryByID(mesh.scene, handle, static_cast<unsigned>(i));
    }
    rtcCommitScene(mesh.scene);
    handles_->throw_failure();
    handles_->meshes.push_back(std::move(mesh));
    return static_cast<std::uint32_t>(handles_->meshes.size() - 1);
}

void EmbreeScene::refit_mesh(std::uint32_t mesh) {
    handles_->throw_failure();
    Handle const& handle = handles_->meshes[mesh];
    for (RTCGeometry const geometry : handle.geometries) {
        rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(geometry);
    }
    rtcCommitScene(handle.scene);
    handles_->throw_failure();
    // The instances' boxes follow only when they are committed as well.
}

std::uint32_t EmbreeScene::add_instance(std::uint32_t mesh) {
    RTCGeometry const instance = rtcNewGeometry(handles_->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, handles_->meshes[mesh].scene);
    rtcDisableGeometry(instance);
    rtcCommitGeometry(instance);
    unsigned const number = static_cast<unsigned>(handles_->instances.size());
    rtcAttachGeometryByID(handles_->still.scene, instance, number);
    handles_->instances.push_back({instance, false});
    ++handles_->still.count;
    return number;
}

void EmbreeScene::place_instance(std::uint32_t instance, Mat3 const& linear, Vec3 const& translation, bool present) {
    handles_->throw_failure();
    Handles::Placed& placed = handles_->instances[instance];
    RTCGeometry const handle = placed.geometry;
    if (handles_->settled && !placed.moves && handles_->instances.size() > few_instances) {
        rtcDetachGeometry(handles_->still.scene, instance);
        rtcAttachGeometryByID(handles_->moving.scene, handle, instance);
        --handles_->still.count;
        ++handles_->moving.count;
        handles_->still.changed = true;
        placed.moves = true;
    }
    handles_->level_of(placed).changed = true;
    if (!present) {
        rtcDisableGeometry(handle);
    } else {
        Vec3 const columns[4] = {linear[0], linear[1], linear[2], translation};
        rtcSetGeometryTransform(handle, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        rtcEnableGeometry(handle);
    }
    rtcCommitGeometry(handle);
    handles_->throw_failure();
}

void EmbreeScene::commit() {
    handles_->throw_failure();
    for (Handles::Level* level : {&handles_->still, &handles_->moving}) {
        if (level->changed) {
            rtcCommitScene(level->scene);
            handles_->throw_failure();
            level->changed = false;
        }
    }
    handles_->settled = true;
}

LaneMask EmbreeScene::intersect(RayPacket const& rays, LaneMask active, Behind behind, HitPacket& hits) const {
    Levels const levels{handles_->still.scene, handles_->moving.count > 0 ? handles_->moving.scene : nullptr};
    RTCFilterFunctionN const filter = behind == Behind::passes ? reject_behind : nullptr;
    if (handles_->sixteen_wide) {
        return intersect_lanes<16>(levels, rays, active, 0, filter, nullptr, hits);
    }
    return intersect_lanes<8>(levels, rays, active, 0, filter, nullptr, hits) |
           intersect_lanes<8>(levels, rays, active, 8, filter, nullptr, hits);
}

LaneMask EmbreeScene::intersect_moving(RayPacket const& rays, LaneMask active, std::span<Instance const> instances,
                                       HitPacket& nearest, HitPacket& farthest) const {
    Levels const levels{handles_->still.scene, handles_->moving.count > 0 ? handles_->moving.scene : nullptr};
    MovingHits moving{instances, nearest, farthest};
    HitPacket standing;
    LaneMask stopped = 0;
    if (handles_->sixteen_wide) {
        stopped = intersect_lanes<16>(levels, rays, active, 0, note_moving, &moving, standing);
    } else {
        stopped = intersect_lanes<8>(levels, rays, active, 0, note_moving, &moving, standing) |
                  intersect_lanes<8>(levels, rays, active, 8, note_moving, &moving, standing);
    }
    return moving.met & ~stopped;
}

LaneMask EmbreeScene::occluded(RayPacket const& rays, LaneMask active, LaneVec3& transmittance) const {
    Levels const levels{handles_->still.scene, handles_->moving.count > 0 ? handles_->moving.scene : nullptr};
    if (handles_->sixteen_wide) {
        return occluded_lanes<16>(levels, rays, active, 0, transmittance);
    }
    return occluded_lanes<8>(levels, rays, active, 0, transmittance) |
           occluded_lanes<8>(levels, rays, active, 8, transmittance);
}

} // namespace framelet
