// Sets bodies and velocities of the instances and the lights.
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "server/render/prepared/prepared_scene.h"
#include "server/render/prepared/render_scene.h"

namespace framelet {
namespace {

/// Seconds to the other scene time from which velocities at `time` are taken: shortly after it, or before it where a
/// clip starts over in between.
double to_other_time(Scene const& scene, std::span<Index const> clips, SceneTime time) {
    constexpr double interval = 1.0 / 120;
    for (Index const clip : clips) {
        double const duration = scene.clips[static_cast<std::size_t>(clip)].duration;
        if (duration > 2 * interval) {
            double const since_start = time - duration * std::floor(time / duration);
            if (since_start + interval >= duration) {
                return -interval;
            }
        }
    }
    return interval;
}

/// Speed, metres a second, from which on a shadow is worth following: a slower one stays where it is for a tenth of a
/// second.
constexpr float fast_shadow = 0.5f;
/// Angular speed, radians a second, above which something spins: a third of a second later it shows another side, and
/// where a ray meets it says little of where its outline goes.
constexpr float fast_spin = 3;

/// Angular speed of an instance, radians a second, from the rate at which its transform changes.
float spin_of(Instance const& instance) {
    Mat3 const change = instance.linear_rate * glm::transpose(instance.normal_matrix); // by the inverse of `linear`
    Vec3 const twice(change[1][2] - change[2][1], change[2][0] - change[0][2], change[0][1] - change[1][0]);
    return 0.5f * glm::length(twice);
}

} // namespace

void RenderScene::set_clips(std::span<Index const> clips) {
    clips_.assign(clips.begin(), clips.end());
    bodies_ = find_bodies(scene_, clips_);
    prepared_->moves = bodies_.any_moves() || bodies_.any_flows();
    velocities_.resize(deformed_.size());
    for (Placement const& placement : placements_) {
        Instance& instance = prepared_->instances[placement.instance];
        instance.body = bodies_.body_of_node[placement.node];
        instance.flows = bodies_.flows[placement.node];
    }
    update_velocities();
}

void RenderScene::update_velocities() {
    if (!prepared_->moves) {
        return;
    }
    prepared_->throws_moving_shadows = false;
    double const seconds = to_other_time(scene_, clips_, pose_.time);
    ScenePose const other = evaluate_pose(scene_, clips_, pose_.time + seconds);
    float const per_second = static_cast<float>(1 / seconds);
    for (Placement const& placement : placements_) {
        Instance& instance = prepared_->instances[placement.instance];
        if (!instance.moves()) {
            continue;
        }
        bool const deforms = instance.flows && reshaped(placement, other);
        for (Geometry& geometry : prepared_->meshes[placement.mesh]) {
            geometry.velocities = {};
        }
        instance.linear_rate = Mat3(0);
        instance.translation_rate = Vec3(0);
        instance.spins = false;
        if (deforms) {
            set_vertex_velocities(placement, other, per_second);
        } else if (moved(placement, other)) {
            Mat4 const& now = pose_.world_from_node[placement.node];
            Mat4 const& then = other.world_from_node[placement.node];
            instance.linear_rate = (Mat3(then) - Mat3(now)) * per_second;
            instance.translation_rate = Vec3(then[3] - now[3]) * per_second;
            instance.spins = spin_of(instance) > fast_spin;
        }
        prepared_->throws_moving_shadows |= deforms || glm::length(instance.translation_rate) > fast_shadow;
    }
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
        RenderLight& light = prepared_->lights[i];
        light.velocity = (make_light(scene_.lights[i], other).position - light.position) * per_second;
    }
}

void RenderScene::set_vertex_velocities(Placement const& placement, ScenePose const& other, float per_second) {
    std::vector<Geometry>& geometries = prepared_->meshes[placement.mesh];
    std::vector<std::vector<Vec3>>& velocities = velocities_[placement.deformed];
    velocities.resize(geometries.size());
    Mat4 const now = placement.skin ? Mat4(1) : pose_.world_from_node[placement.node];
    Mat4 const then = placement.skin ? Mat4(1) : other.world_from_node[placement.node];
    for (std::size_t i = 0; i < geometries.size(); ++i) {
        Geometry& geometry = geometries[i];
        deform(*geometry.source, other.morph_weights[placement.node], placement.skin, other, elsewhen_);
        velocities[i].resize(geometry.positions.size());
        for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
            Vec4 const to = then * Vec4(elsewhen_.positions[v], 1), from = now * Vec4(geometry.positions[v], 1);
            velocities[i][v] = Vec3(to - from) * per_second;
        }
        geometry.velocities = velocities[i];
    }
}

} // namespace framelet
