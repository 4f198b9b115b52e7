#include "server/render/trace/sample_motion.h"

#include "server/render/surface/hit_frame.h"

namespace framelet {

Vec3 velocity_at(Instance const& instance, HitPacket const& hits, int lane) {
    Geometry const& geometry = instance.geometries[hits.geometry[lane]];
    TrianglePoint const point = point_of(geometry, hits.triangle[lane], hits.u[lane], hits.v[lane]);
    if (!geometry.velocities.empty()) {
        return point.interpolate(geometry.velocities);
    }
    Vec3 const position = point.interpolate(std::span<Vec3 const>(geometry.positions));
    return instance.linear_rate * position + instance.translation_rate;
}

void add_motion(PreparedScene const& scene, TracedPacket const& traced, int first, Framelet& out) {
    for (int i = 0; i < lanes; ++i) {
        std::uint32_t const number = traced.surface.instance[i];
        if (number == no_instance) {
            continue;
        }
        Instance const& instance = scene.instances[number];
        auto const sample = static_cast<std::size_t>(first + i);
        if (instance.body != static_body) {
            if (out.body.empty()) {
                out.body.assign(framelet_samples, static_body);
            }
            out.body[sample] = instance.body;
        } else if (instance.flows) {
            if (out.velocity.empty()) {
                out.velocity.assign(framelet_samples, Vec3(0));
            }
            out.velocity[sample] = velocity_at(instance, traced.surface, i);
        }
    }
}

} // namespace framelet
