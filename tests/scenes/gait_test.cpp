#include "scenes/things/gait.h"

#include <cmath>

#include <gtest/gtest.h>

namespace framelet {
namespace {

using enum FigureJoint;

struct Way {
    char const* name;
    Gait gait;
    GaitPath path;
};

class GaitOf : public testing::TestWithParam<Way> {
protected:
    static constexpr int phases = 200;

    /// A point fixed to a joint, seen by whoever stands in the middle of the way.
    D3 point(double phase, FigureJoint joint, int side, D3 offset) const {
        GaitPath const& path = GetParam().path;
        FigurePose const pose = pose_of(GetParam().gait, path, phase);
        D3 at = offset;
        int i = joint_number(joint, side);
        for (; i != joint_number(pelvis); i = parent_joint(i)) {
            at = joint_place(i) - joint_place(parent_joint(i)) + pose.rotations.at(static_cast<std::size_t>(i)) * at;
        }
        at = pose.pelvis + pose.rotations[0] * at;
        double const gone = (path.radius > 0 ? 2 : -2) * pi * phase / path.cycles;
        return rotation_about({0, 1, 0}, gone) * (at - D3(path.radius, 0, 0));
    }
    /// A place of a sole, which lies so far before the ankle.
    D3 sole(double phase, int side, double z) const { return point(phase, foot, side, {0, -0.08, z}); }
};

TEST_P(GaitOf, FeetOnTheGroundDoNotSlide) {
    struct Touching {
        double z, from, until; ///< a place of the sole, and the shares of the stance for which it is on the ground
    };
    for (int side = 0; side < 2; ++side) {
        for (Touching const& touching : {Touching{-0.05, 0, 0.5}, Touching{0.13, 0.2, 1}}) {
            auto const at = [&](double share) {
                double const phase = 0.5 * side + GetParam().gait.stance * share;
                return std::pair(phase, sole(phase, side, touching.z));
            };
            D3 const place = at(0.3).second;
            for (double share = touching.from; share < touching.until; share += 0.01) {
                auto const [phase, now] = at(share);
                EXPECT_NEAR(now.y, 0, 1e-6) << "side " << side << ", phase " << phase;
                EXPECT_LT(glm::distance(now, place), 1e-6) << "side " << side << ", phase " << phase;
            }
        }
    }
}

TEST_P(GaitOf, FeetStayAboveTheGroundAndKneesBendBackward) {
    for (int i = 0; i < phases; ++i) {
        double const phase = double(i) / phases;
        FigurePose const pose = pose_of(GetParam().gait, GetParam().path, phase);
        for (int side = 0; side < 2; ++side) {
            EXPECT_GT(sole(phase, side, -0.05).y, -1e-6) << phase;
            EXPECT_GT(sole(phase, side, 0.13).y, -1e-6) << phase;
            DQuat const knee = pose.rotations.at(static_cast<std::size_t>(joint_number(shin, side)));
            EXPECT_GT(knee.x, 0) << phase;
        }
    }
}

TEST_P(GaitOf, TheRightSideDoesWhatTheLeftOneDidHalfACycleBefore) {
    GaitPath const& path = GetParam().path;
    GaitPath const other{-path.radius, path.cycles, path.duration};
    FigurePose const left = pose_of(GetParam().gait, path, 0.2);
    FigurePose const right = pose_of(GetParam().gait, other, 0.7);
    for (FigureJoint const joint : {upper_arm, forearm, thigh, shin, foot}) {
        DQuat const a = left.rotations.at(static_cast<std::size_t>(joint_number(joint, 0)));
        DQuat const b = right.rotations.at(static_cast<std::size_t>(joint_number(joint, 1)));
        EXPECT_NEAR(std::abs(glm::dot(a, DQuat(b.w, b.x, -b.y, -b.z))), 1, 1e-9) << "mirrored";
    }
}

TEST_P(GaitOf, ComesRoundWithoutAJump) {
    FigurePose const end = pose_of(GetParam().gait, GetParam().path, 1 - 1e-9);
    FigurePose const start = pose_of(GetParam().gait, GetParam().path, 0);
    EXPECT_LT(glm::distance(end.pelvis, start.pelvis), 1e-6);
    for (std::size_t joint = 0; joint < start.rotations.size(); ++joint) {
        EXPECT_NEAR(std::abs(glm::dot(end.rotations[joint], start.rotations[joint])), 1, 1e-9);
    }
}

INSTANTIATE_TEST_SUITE_P(Ways, GaitOf,
                         testing::Values(Way{"walking", walking, {1.05, 5, 4}}, Way{"running", running, {-2.2, 6, 4}},
                                         Way{"the_other_way", walking, {-1.05, 5, 4}}),
                         [](auto const& instance) { return std::string(instance.param.name); });

} // namespace
} // namespace framelet
