// Finds how things move about the present time of the scene: where they are a little before and after it.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tbb/parallel_for.h>

#include "server/render/prepared/prepared_scene.h"
#include "server/render/prepared/render_scene.h"

namespace framelet {
namespace {

/// Metres by which something goes within `motion_step` from which on its shadow is worth following.
constexpr float least_shadow_step = 0.5f * motion_step;
/// Angular speed, radians a second, above which what goes along rolls: a third of a second later it shows another
/// side, and where a ray meets it says little of where its outline goes.
constexpr float fast_spin = 3;
/// Metres a second from which on something goes along.
constexpr float slowest_rolling = 0.01f;

/// Angle by which an instance turns between two placements, radians, for turns of less than half a circle.
float turn_between(WorldPlacement const& before, WorldPlacement const& after) {
    Mat3 const turn = after.linear * glm::inverse(before.linear);
    Vec3 const twice(turn[1][2] - turn[2][1], turn[2][0] - turn[0][2], turn[0][1] - turn[1][0]);
    float const cosine = 0.5f * (turn[0][0] + turn[1][1] + turn[2][2] - 1);
    return std::atan2(0.5f * glm::length(twice), cosine);
}

WorldPlacement placement_of(Mat4 const& world) {
    return {Mat3(world), Vec3(world[3])};
}

WorldPlacement placement_of(BodyPose const& pose) {
    Mat3 linear = glm::mat3_cast(pose.rotation);
    for (int axis = 0; axis < 3; ++axis) {
        linear[axis] *= pose.scale[axis];
    }
    return {linear, pose.translation};
}

} // namespace

void RenderScene::set_clips(std::span<Index const> clips) {
    clips_.assign(clips.begin(), clips.end());
    other_poses_.emplace(scene_, clips_);
    bodies_ = find_bodies(scene_, clips_);
    switches_ = find_switches(scene_, clips_);
    prepared_->moves = bodies_.any_moves() || bodies_.any_flows();
    deformed_motion_.resize(deformed_.size());
    for (Placement const& placement : placements_) {
        Instance& instance = prepared_->instances[placement.instance];
        instance.body = bodies_.body_of_node[placement.node];
        instance.flows = bodies_.flows[placement.node];
        if (!placement.deforms()) {
            continue;
        }
        std::vector<Geometry>& geometries = prepared_->meshes[placement.mesh];
        std::vector<DeformedMotion>& motion = deformed_motion_[placement.deformed];
        motion.resize(geometries.size());
        for (std::size_t i = 0; i < geometries.size(); ++i) {
            Geometry& geometry = geometries[i];
            geometry.elsewhen = {};
            motion[i].bodies.clear();
            if (placement.skin != nullptr && instance.flows) {
                auto const skin = static_cast<std::size_t>(scene_.nodes[placement.node].skin);
                for (auto const& triangle : geometry.source->triangles) {
                    motion[i].bodies.push_back(bodies_.body_of_joint[skin][joint_of(*geometry.source, triangle)]);
                }
            }
            geometry.bodies = motion[i].bodies;
        }
    }
    update_motion();
}

void RenderScene::update_motion() {
    if (!prepared_->moves) {
        return;
    }
    MotionTimes& times = prepared_->times;
    for (std::size_t k = 0; k < motion_times; ++k) {
        SceneTime const time = pose_.time + static_cast<double>(motion_seconds[k]);
        times.usable[k] = !switches_within(switches_, std::min(time, pose_.time), std::max(time, pose_.time)).any;
        ScenePose const& other = other_poses_->at(time);
        move_bodies(k, other);
        times.lights[k].clear();
        for (Light const& light : scene_.lights) {
            times.lights[k].push_back(make_light(light, other));
        }
        if (scene_.lights.empty()) {
            times.lights[k] = prepared_->lights;
        }
        tbb::parallel_for(std::size_t{0}, placements_.size(), [&](std::size_t i) {
            if (prepared_->instances[placements_[i].instance].moves()) {
                place_elsewhen(placements_[i], k, other);
            }
        });
    }
    prepared_->throws_moving_shadows = false;
    for (Placement const& placement : placements_) {
        Instance& instance = prepared_->instances[placement.instance];
        if (!instance.moves()) {
            continue;
        }
        std::size_t const k = times.usable[1] ? 1 : 0;
        WorldPlacement const& other = instance.elsewhen[k];
        float const gone = glm::distance(other.translation, instance.translation);
        float const turn = placement.deforms() ? 0 : turn_between({instance.linear, instance.translation}, other);
        instance.rolls = gone > slowest_rolling * motion_step && turn > fast_spin * motion_step;
        prepared_->throws_moving_shadows = prepared_->throws_moving_shadows || throws_moving_shadow(placement);
    }
}

/// True when something of the instance goes so fast that its shadow does not stay where it is.
bool RenderScene::throws_moving_shadow(Placement const& placement) const {
    Instance const& instance = prepared_->instances[placement.instance];
    if (!instance.geometries.empty() && !instance.geometries.front().elsewhen[0].empty()) {
        return true;
    }
    WorldPlacement const& other = instance.elsewhen[prepared_->times.usable[1] ? 1 : 0];
    return std::ranges::any_of(instance.geometries, [&](Geometry const& geometry) {
        constexpr std::size_t step = 16; // vertices: a part of them says as much
        for (std::size_t i = 0; i < geometry.positions.size(); i += step) {
            Vec3 const now = instance.linear * geometry.positions[i] + instance.translation;
            if (glm::distance(other.of(geometry.positions[i]), now) > least_shadow_step) {
                return true;
            }
        }
        return false;
    });
}

void RenderScene::place_elsewhen(Placement const& placement, std::size_t time, ScenePose const& other) {
    Instance& instance = prepared_->instances[placement.instance];
    instance.elsewhen[time] =
        placement.skin != nullptr ? WorldPlacement{} : placement_of(other.world_from_node[placement.node]);
    if (placement.deforms() && instance.flows) {
        deform_elsewhen(placement, time, other);
    }
}

void RenderScene::deform_elsewhen(Placement const& placement, std::size_t time, ScenePose const& other) {
    std::vector<Geometry>& geometries = prepared_->meshes[placement.mesh];
    WorldPlacement const& placed = prepared_->instances[placement.instance].elsewhen[time];
    for (std::size_t i = 0; i < geometries.size(); ++i) {
        Geometry& geometry = geometries[i];
        std::vector<Vec3>& positions = deformed_motion_[placement.deformed][i].elsewhen[time];
        positions.resize(geometry.positions.size());
        deform_positions(*geometry.source, other.morph_weights[placement.node], placement.skin, other, placed.linear,
                         placed.translation, positions);
        geometry.elsewhen[time] = positions;
    }
}

/// Finds what bodies do to points between the present time and the other one; only what drifts is compared with it.
void RenderScene::move_bodies(std::size_t time, ScenePose const& other) {
    std::vector<WorldPlacement>& moved = prepared_->times.of_body[time];
    moved.clear();
    if (!bodies_.any_flows()) {
        return;
    }
    for (std::size_t body = 0; body < bodies_.frames.size(); ++body) {
        auto const number = static_cast<BodyNumber>(body);
        WorldPlacement const now = placement_of(body_pose(bodies_, pose_, number));
        WorldPlacement const then = placement_of(body_pose(bodies_, other, number));
        Mat3 const linear = then.linear * glm::inverse(now.linear);
        Vec3 const translation = then.translation - linear * now.translation;
        bool const is_finite = std::isfinite(glm::dot(linear[0] + linear[1] + linear[2] + translation, Vec3(1)));
        moved.push_back(is_finite ? WorldPlacement{linear, translation} : WorldPlacement{});
    }
}

} // namespace framelet
