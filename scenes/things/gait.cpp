#include "scenes/things/gait.h"

#include <algorithm>
#include <cmath>

#include "scenes/gltf/animations.h"

namespace framelet {
namespace {

using enum FigureJoint;

constexpr D3 axis_x{1, 0, 0};
constexpr D3 axis_y{0, 1, 0};
constexpr D3 axis_z{0, 0, 1};
constexpr double gravity = 9.81; // metres / seconds squared
/// Of the sole's ends, from the ankle.
constexpr double ball = 0.13, heel = -0.05; // metres

/// A cubic from a to b, `t` in [0, 1], with the same slope at both ends.
double cubic(double a, double b, double slope, double t) {
    return glm::mix(a, b, smooth_step(t)) + slope * t * (1 - t) * (1 - 2 * t);
}

/// Where one foot is: its way along the path from below the hips, its ankle before that place and above the ground
/// (metres), and how far its toes point down.
struct FootPlace {
    double along, forward, height, pitch;
};

/// On the ground it rolls about its heel, its whole sole and its ball, none of which slides.
FootPlace foot_on_ground(Gait const& gait, double stride, double phase) {
    double const share = phase / gait.stance;
    double const pitch = share < 0.5 ? -gait.toe_up * (1 - smooth_step(share / 0.2))
                                     : gait.heel_up * std::pow(std::max(2 * share - 1, 0.0), 1.6);
    double const ankle = joint_place(joint_number(foot)).y;
    double const pivot = pitch > 0 ? ball : heel;
    double const c = std::cos(pitch);
    double const s = std::sin(pitch);
    return {gait.reach - stride * phase, pivot - (pivot * c - ankle * s), ankle * c + pivot * s, pitch};
}

FootPlace foot_at(Gait const& gait, double stride, double phase) {
    if (phase < gait.stance) {
        return foot_on_ground(gait, stride, phase);
    }
    FootPlace const left = foot_on_ground(gait, stride, gait.stance);
    FootPlace const next = foot_on_ground(gait, stride, 0);
    double const t = (phase - gait.stance) / (1 - gait.stance);
    double const raised = std::sin(pi * std::pow(t, 0.75)); // most in the first half
    return {cubic(left.along, next.along, -0.4 * stride * (1 - gait.stance), t),
            glm::mix(left.forward, next.forward, smooth_step(t)),
            glm::mix(left.height, next.height, smooth_step(t)) + gait.lift * raised * raised,
            glm::mix(left.pitch, next.pitch, smooth_step(t)) + gait.swing_pitch * raised * raised};
}

/// Sets the rotations of a leg so that its foot is in its place, the knee forward.
void place_leg(FigurePose& pose, GaitPath const& path, FootPlace const& place, int side) {
    int const hip = joint_number(thigh, side);
    double const turned = place.along / path.radius;
    DQuat const heading = rotation_about(axis_y, turned);
    double const apart = 0.7 * joint_place(hip).x; // feet come down nearer to the middle than the hips are
    D3 const ankle = heading * D3(apart - path.radius, place.height, place.forward) + D3(path.radius, 0, 0);

    DQuat const pelvis_rotation = pose.rotations[0];
    D3 const hip_place = pose.pelvis + pelvis_rotation * (joint_place(hip) - joint_place(joint_number(pelvis)));
    double const length = joint_place(hip).y - joint_place(joint_number(shin, side)).y; // of the thigh, and of the shin
    DQuat const facing = rotation_about(axis_y, 0.5 * turned);
    D3 const way = glm::inverse(pelvis_rotation * facing) * (ankle - hip_place);
    double const distance = std::min(glm::length(way), 1.999 * length);
    D3 const direction = glm::normalize(way);
    double const bend = std::acos(distance / (2 * length));
    DQuat const upper = facing * rotation_about(axis_z, std::atan2(direction.x, -direction.y)) *
                        rotation_about(axis_x, -std::asin(direction.z) - bend);
    DQuat const lower = rotation_about(axis_x, 2 * bend);
    auto const set = [&](FigureJoint joint, DQuat const& rotation) {
        pose.rotations.at(static_cast<std::size_t>(joint_number(joint, side))) = rotation;
    };
    set(thigh, upper);
    set(shin, lower);
    set(foot, glm::inverse(pelvis_rotation * upper * lower) * heading * rotation_about(axis_x, place.pitch));
}

} // namespace

FigurePose pose_of(Gait const& gait, GaitPath const& path, double phase) {
    FigurePose pose;
    pose.rotations.fill(DQuat(1, 0, 0, 0));
    auto const rotation = [&](FigureJoint joint, int side = 0) -> DQuat& {
        return pose.rotations.at(static_cast<std::size_t>(joint_number(joint, side)));
    };
    double const stride = 2 * pi * std::abs(path.radius) / path.cycles;
    double const speed = 2 * pi * std::abs(path.radius) / path.duration;
    double const swing = std::cos(2 * pi * phase); // 1: the left foot is before, the right arm too
    double const hips = gait.hip_height - gait.hip_bob * std::cos(4 * pi * (phase - gait.lowest));

    // Into the curve, as whoever goes it has to.
    DQuat const banked = rotation_about(axis_z, -std::atan(speed * speed / (gravity * path.radius)));
    double const above_hips = joint_place(joint_number(pelvis)).y - joint_place(joint_number(thigh)).y;
    pose.pelvis = banked * D3(0.02 * std::sin(2 * pi * phase), hips + above_hips, 0);
    double const twist = gait.twist * swing;
    rotation(pelvis) = banked * rotation_about(axis_y, -twist) *
                       rotation_about(axis_z, -0.4 * gait.twist * std::sin(2 * pi * phase)) *
                       rotation_about(axis_x, 0.3 * gait.lean);
    rotation(spine) = rotation_about(axis_y, 0.9 * twist) * rotation_about(axis_x, 0.4 * gait.lean);
    rotation(chest) = rotation_about(axis_y, 1.1 * twist) * rotation_about(axis_x, 0.3 * gait.lean);
    double const into_curve = 0.25 * (path.radius > 0 ? 1 : -1);
    rotation(head) = rotation_about(axis_y, into_curve - twist) * rotation_about(axis_x, -0.8 * gait.lean);
    for (int side = 0; side < 2; ++side) {
        double const forward = side == 0 ? -swing : swing;
        rotation(upper_arm, side) = rotation_about(axis_x, 0.12 * gait.elbow - gait.arm_swing * forward);
        rotation(forearm, side) = rotation_about(axis_x, -gait.elbow * (1 + 0.35 * forward));
        double const own_phase = std::fmod(phase + 0.5 * side, 1.0);
        place_leg(pose, path, foot_at(gait, stride, own_phase), side);
    }
    return pose;
}

void add_going_figure(GltfDocument& document, int mesh, Gait const& gait, GaitPath const& path, D3 center,
                      double start_angle) {
    int const middle = document.add_node({.name = "way", .place = {center}});
    double const turn = path.radius > 0 ? 2 * pi : -2 * pi;
    document.tracks.push_back(spin_track({middle}, axis_y, turn, path.duration));
    DQuat const start = rotation_about(axis_y, start_angle);
    DQuat const facing = rotation_about(axis_y, path.radius > 0 ? start_angle + pi : start_angle);
    Figure const figure = add_figure(document, mesh, {start * D3(std::abs(path.radius), 0, 0), facing}, middle);

    int const keys = 20 * path.cycles;
    auto const at = [&](double time) {
        return pose_of(gait, path, std::fmod(path.cycles * time / path.duration, 1.0));
    };
    int const hips = figure.joints[0];
    document.tracks.push_back(
        translation_track(hips, path.duration, keys, [&](double time) { return at(time).pelvis; }));
    for (std::size_t joint = 0; joint < figure.joints.size(); ++joint) {
        document.tracks.push_back(rotation_track(figure.joints[joint], path.duration, keys,
                                                 [&](double time) { return at(time).rotations[joint]; }));
    }
}

} // namespace framelet
