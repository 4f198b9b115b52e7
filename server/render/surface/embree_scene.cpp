#include "server/render/surface/embree_scene.h"

#include <atomic>
#include <cstring>
#include <new>
#include <vector>

#include <spdlog/spdlog.h>

#include "common/error.h"
#include "server/render/surface/embree_queries.h"
#include "server/scene/reading/held_exception.h"

namespace framelet {
namespace {

/// Scenes of at most this many instances have one top level, whatever moves in them.
constexpr std::size_t few_instances = 256;

struct Handle {
    RTCScene scene = nullptr;
    std::vector<RTCGeometry> geometries;
};

void report(void*, RTCError code, char const* message) {
    if (code == RTC_ERROR_CANCELLED) { // as we wanted
        return;
    }
    spdlog::error("Embree error {}: {}", static_cast<int>(code), message ? message : "");
}

/// What Embree is handed to say how far a BVH is built.
struct BuildMonitor {
    std::function<void(double)> const& progress;
    HeldException held = {};
};

bool report_progress(void* monitor, double fraction) {
    auto& m = *static_cast<BuildMonitor*>(monitor);
    return m.held.call([&] { m.progress(fraction); });
}

void commit_with_progress(RTCScene scene, std::function<void(double)> const& progress) {
    BuildMonitor monitor{progress};
    rtcSetSceneProgressMonitorFunction(scene, report_progress, &monitor);
    rtcCommitScene(scene);
    rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
    monitor.held.rethrow();
}

} // namespace

struct EmbreeScene::Handles {
    /// One of the two top levels.
    struct Level {
        RTCScene scene = nullptr;
        std::size_t count = 0;
        bool changed = true;
    };
    struct InstanceHandle {
        RTCGeometry geometry = nullptr;
        bool moves = false;
    };

    Handles();
    ~Handles();
    Handles(Handles const&) = delete;
    Handles& operator=(Handles const&) = delete;

    RTCDevice device = nullptr;
    bool sixteen_wide = false;
    std::vector<Handle> meshes;
    std::vector<InstanceHandle> instances;
    /// Where many instances stand still and few move, the two kinds have a level each: rebuilding one of thousands of
    /// instances takes milliseconds, tracing a second small one nanoseconds.
    Level still, moving;
    bool settled = false; ///< committed once: what is placed again from now on moves
    std::atomic<bool> broken =
        false; ///< memory was missing: Embree may have left half of something, and is not asked again

    TopLevels levels() const { return {still.scene, moving.count > 0 ? moving.scene : nullptr, sixteen_wide}; }
    Level& level_of(InstanceHandle const& instance) { return instance.moves ? moving : still; }

    /// Throws std::bad_alloc where memory is missing. It is called after what takes memory; before it as well, so that
    /// nothing follows what has failed.
    void throw_failure() {
        RTCError const error = rtcGetDeviceError(device);
        broken = broken || error == RTC_ERROR_OUT_OF_MEMORY || error == RTC_ERROR_UNKNOWN;
        if (broken) {
            throw std::bad_alloc();
        }
    }
};

EmbreeScene::Handles::Handles() {
    rtcGetDeviceError(nullptr); // forgets what calls for handles that could not be made have left on this thread
    device = rtcNewDevice(nullptr);
    if (device == nullptr) {
        RTCError const error = rtcGetDeviceError(nullptr);
        FRAMELET_CHECK(error == RTC_ERROR_OUT_OF_MEMORY || error == RTC_ERROR_UNKNOWN);
        throw std::bad_alloc();
    }
    rtcSetDeviceErrorFunction(device, report, nullptr);
    sixteen_wide = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
    for (Level* level : {&still, &moving}) {
        level->scene = rtcNewScene(device);
        rtcSetSceneFlags(level->scene, query_filters);
        rtcCommitScene(level->scene);
    }
}

EmbreeScene::Handles::~Handles() {
    // What could not be made is null.
    auto const release = [](auto handle, auto const& how) {
        if (handle != nullptr) {
            how(handle);
        }
    };
    for (InstanceHandle const& instance : instances) {
        release(instance.geometry, rtcReleaseGeometry);
    }
    release(still.scene, rtcReleaseScene);
    release(moving.scene, rtcReleaseScene);
    for (Handle const& mesh : meshes) {
        for (RTCGeometry const geometry : mesh.geometries) {
            release(geometry, rtcReleaseGeometry);
        }
        release(mesh.scene, rtcReleaseScene);
    }
    rtcReleaseDevice(device);
}

EmbreeScene::EmbreeScene() {
    clear();
}

EmbreeScene::~EmbreeScene() = default;

void EmbreeScene::clear() {
    handles_.reset(); // its memory may be what is missing
    handles_ = std::make_unique<Handles>();
    handles_->throw_failure();
}

bool EmbreeScene::is_broken() const {
    return handles_ == nullptr || handles_->broken;
}

std::uint32_t EmbreeScene::add_mesh(std::span<Geometry> geometries, bool deforming,
                                    std::function<void(double)> const& progress) {
    Handle& mesh = handles_->meshes.emplace_back(); // released with the others, whatever happens here
    mesh.geometries.reserve(geometries.size());
    mesh.scene = rtcNewScene(handles_->device);
    rtcSetSceneFlags(mesh.scene, query_filters | (deforming ? RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_NONE) |
                                     (kind_ == BvhKind::compact ? RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_NONE));
    if (deforming) { // what is above the geometries is built anew for each pose: four times as fast so
        rtcSetSceneBuildQuality(mesh.scene, RTC_BUILD_QUALITY_LOW);
    }
    for (std::size_t i = 0; i < geometries.size(); ++i) {
        Geometry& geometry = geometries[i];
        Primitive const& source = *geometry.source;
        RTCGeometry const handle = rtcNewGeometry(handles_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        mesh.geometries.push_back(handle);
        if (source.positions.empty() || source.triangles.empty()) {
            continue; // a geometry that is not attached keeps the numbers of the others
        }
        geometry.positions = source.positions;
        // Embree reads 16 bytes at a vertex.
        bool const can_share = source.positions.capacity() > source.positions.size();
        if (can_share && !deforming) {
            rtcSetSharedGeometryBuffer(handle, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, source.positions.data(), 0,
                                       sizeof(Vec3), source.positions.size());
        } else {
            void* const vertices = rtcSetNewGeometryBuffer(handle, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                           sizeof(Vec3), source.positions.size());
            handles_->throw_failure();
            FRAMELET_CHECK(vertices != nullptr);
            std::memcpy(vertices, source.positions.data(), source.positions.size() * sizeof(Vec3));
            geometry.positions = {static_cast<Vec3*>(vertices), source.positions.size()};
        }
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
    if (progress) {
        commit_with_progress(mesh.scene, progress);
    } else {
        rtcCommitScene(mesh.scene);
    }
    handles_->throw_failure();
    return static_cast<std::uint32_t>(handles_->meshes.size() - 1);
}

std::span<Vec3> EmbreeScene::positions(std::uint32_t mesh, std::size_t geometry) {
    RTCGeometry const handle = handles_->meshes[mesh].geometries[geometry];
    auto const* const of = static_cast<Geometry const*>(rtcGetGeometryUserData(handle));
    if (of == nullptr) {
        return {};
    }
    return {static_cast<Vec3*>(rtcGetGeometryBufferData(handle, RTC_BUFFER_TYPE_VERTEX, 0)), of->positions.size()};
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
    unsigned const number = static_cast<unsigned>(handles_->instances.size());
    RTCGeometry& instance = handles_->instances.emplace_back().geometry;
    instance = rtcNewGeometry(handles_->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, handles_->meshes[mesh].scene);
    rtcDisableGeometry(instance);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(handles_->still.scene, instance, number);
    ++handles_->still.count;
    handles_->throw_failure();
    return number;
}

void EmbreeScene::set_instance(std::uint32_t instance, Mat3 const& linear, Vec3 const& translation, bool present) {
    handles_->throw_failure();
    Handles::InstanceHandle& placed = handles_->instances[instance];
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
    RTCFilterFunctionN const filter = behind == Behind::passes ? reject_behind : nullptr;
    return intersect_packet(handles_->levels(), rays, active, filter, nullptr, hits);
}

LaneMask EmbreeScene::intersect_moving(RayPacket const& rays, LaneMask active, std::span<Instance const> instances,
                                       HitPacket& nearest, HitPacket& farthest) const {
    MovingHits moving{instances, nearest, farthest};
    HitPacket standing;
    LaneMask const stopped = intersect_packet(handles_->levels(), rays, active, note_moving, &moving, standing);
    return moving.met & ~stopped;
}

LaneMask EmbreeScene::occluded(RayPacket const& rays, LaneMask active, LaneVec3& transmittance) const {
    return occlude_packet(handles_->levels(), rays, active, transmittance);
}

} // namespace framelet
