// How a figure walks or runs along a circle. In: the way it goes, a phase of its step. Out: rotations of its joints.
#pragma once

#include "scenes/things/figure.h"

namespace framelet {

/// What differs between walking and running; lengths in metres, angles in radians.
struct Gait {
    double stance; ///< share of a cycle (two steps) for which a foot is on the ground
    double reach; ///< how far before the hips it comes down
    double hip_height, hip_bob; ///< mean, and how far it rises and sinks
    double lowest; ///< phase, after a foot comes down, at which the hips are lowest
    double toe_up, heel_up; ///< pitch of a foot that comes down, and of one that is lifted
    double lift, swing_pitch; ///< how much higher, and more pitched, a foot is while it swings
    double arm_swing, elbow; ///< of the upper arm to either side; bend of the elbow
    double lean, twist; ///< of the trunk: forward; of the hips to either side
};
inline constexpr Gait walking{0.60, 0.35, 0.868, 0.020, 0.02, 0.30, 0.75, 0.05, 0.1, 0.42, 0.30, 0.04, 0.10};
inline constexpr Gait running{0.32, 0.23, 0.840, 0.030, 0.16, 0.10, 0.85, 0.22, 0.7, 0.70, 1.50, 0.16, 0.14};

/// The way: round a circle whose middle is `radius` metres to the figure's left (below 0: to its right).
struct GaitPath {
    double radius;
    int cycles; ///< on the whole circle
    double duration; ///< seconds for the whole circle
};

/// Where the pelvis is in the space of the figure's root, which goes along the path, and each joint's rotation.
struct FigurePose {
    D3 pelvis;
    std::array<DQuat, figure_joints> rotations;
};
/// The pose at a phase of the cycle, in [0, 1): the left foot comes down at 0, the right one at 0.5.
FigurePose pose_of(Gait const& gait, GaitPath const& path, double phase);

/// Adds a figure that goes round `center` for the path's duration, and the tracks that move it. At the start it is at
/// this angle from +X towards -Z, radians.
void add_going_figure(GltfDocument& document, int mesh, Gait const& gait, GaitPath const& path, D3 center,
                      double start_angle);

} // namespace framelet
