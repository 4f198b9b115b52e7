#include "common/framelet/body_motion.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace framelet {
namespace {

constexpr double key_seconds = 1.0 / body_keys_per_second;

/// The track of a wheel that turns about +Y at `speed` (radians a second) around an axle that moves along +X at 2
/// metres a second.
BodyTrack wheel(float speed, std::int64_t first_key, int keys) {
    BodyTrack track{7, first_key, {}};
    for (int i = 0; i < keys; ++i) {
        auto const time = static_cast<float>(first_key + i) / body_keys_per_second;
        track.keys.push_back({Vec3(2 * time, 1, 0), glm::angleAxis(speed * time, Vec3(0, 1, 0)), Vec3(1)});
    }
    return track;
}

glm::dvec3 move(Motion const& motion, glm::dvec3 point) {
    return motion.linear * point + motion.offset;
}

TEST(BodyMotion, KeysAreMetAndBetweenThemRotationIsUniform) {
    BodyTrack const track = wheel(3, 30, 10);
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(pose_at(track, (30 + i) * key_seconds).translation.x,
                  track.keys[static_cast<std::size_t>(i)].translation.x);
    }
    for (double time = 0.5; time < 0.65; time += 0.0037) {
        BodyPose const pose = pose_at(track, time);
        EXPECT_NEAR(pose.translation.x, 2 * time, 1e-6);
        EXPECT_NEAR(glm::angle(pose.rotation), 3 * time, 1e-5);
    }
}

TEST(BodyMotion, TimeIsClampedBeforeTheKeysAndExtrapolatedALittleAfterThem) {
    BodyTrack const track = wheel(3, 30, 10); // keys end at 0.65 s
    EXPECT_EQ(pose_at(track, 0), track.keys.front());
    EXPECT_NEAR(pose_at(track, 0.7).translation.x, 1.4f, 1e-5f);
    EXPECT_NEAR(glm::angle(pose_at(track, 0.7).rotation), 2.1f, 1e-4f);
    float const farthest = 2 * (0.65f + static_cast<float>(max_pose_extrapolation_seconds));
    EXPECT_NEAR(pose_at(track, 1).translation.x, farthest, 1e-5f);
    EXPECT_EQ(pose_at(track, 1), pose_at(track, 1e300));
    EXPECT_EQ(pose_at(track, -1e300), track.keys.front());
}

TEST(BodyMotion, ShorterArcIsTakenWhateverTheSignOfTheQuaternions) {
    BodyTrack track = wheel(3, 0, 2);
    BodyPose const expected = pose_at(track, key_seconds / 2);
    track.keys[1].rotation = -track.keys[1].rotation;
    BodyPose const pose = pose_at(track, key_seconds / 2);
    EXPECT_NEAR(std::abs(glm::dot(pose.rotation, expected.rotation)), 1, 1e-6);
}

TEST(BodyMotion, MovesPointsOfTheBody) {
    BodyTrack const track = wheel(3, 0, 120);
    double const from = 0.4, to = 0.55;
    for (double const angle : {0.0, 1.0, 2.5}) {
        auto const position_at = [&](double time) {
            double const a = 3 * time + angle;
            return glm::dvec3(2 * time + std::cos(a), 1, -std::sin(a));
        };
        EXPECT_LT(glm::distance(move(motion_between(track, from, to), position_at(from)), position_at(to)), 1e-5);
    }
}

TEST(BodyMotion, WhatSpinsAsItGoesFollowsItsAxle) {
    // A car turns about +Z by 2 radians a second; the axle of its wheel is its own +Y.
    auto const car_turn = [](double time) { return glm::angleAxis(2 * time, glm::dvec3(0, 0, 1)); };
    auto const wheel_of_car = [&](double speed, std::int64_t spins_until) {
        BodyTrack track{7, 0, {}};
        for (std::int64_t i = 0; i < 60; ++i) {
            double const time = static_cast<double>(i) * key_seconds;
            double const spun = speed * static_cast<double>(std::min(i, spins_until)) * key_seconds;
            track.keys.push_back({Vec3(20 * static_cast<float>(time), 0, 0),
                                  glm::quat(car_turn(time) * glm::angleAxis(spun, glm::dvec3(0, 1, 0))), Vec3(0.3f)});
        }
        return track;
    };
    double const from = 0.2, to = 0.35;
    glm::dquat const turn = car_turn(to) * glm::conjugate(car_turn(from));
    for (double const speed : {40.0, -66.0, 100.0}) {
        Motion const motion = motion_between(wheel_of_car(speed, 60), from, to);
        glm::dvec3 const axle = car_turn(from) * glm::dvec3(0, 1, 0);
        glm::dvec3 const tread = car_turn(from) * glm::dvec3(0.3, 0, 0);
        glm::dvec3 const centre(20 * from, 0, 0);
        EXPECT_LT(glm::distance(move(motion, centre), glm::dvec3(20 * to, 0, 0)), 1e-5);
        EXPECT_LT(glm::distance(motion.linear * axle, turn * axle), 0.05) << speed; // the car turns meanwhile
        EXPECT_LT(glm::distance(motion.linear * tread, turn * tread), 0.05) << speed;
        EXPECT_NEAR(glm::determinant(motion.linear), 1, 1e-5);
    }
    auto const spoke_moved = [&](BodyTrack const& track) {
        glm::dvec3 const spoke = glm::dquat(pose_at(track, from).rotation) * glm::dvec3(1, 0, 0);
        glm::dvec3 const there = glm::dquat(pose_at(track, to).rotation) * glm::dvec3(1, 0, 0);
        return glm::distance(motion_between(track, from, to).linear * spoke, there);
    };
    EXPECT_LT(spoke_moved(wheel_of_car(25, 60)), 1e-5) << "an eye can follow it";
    EXPECT_LT(spoke_moved(wheel_of_car(66, 15)), 1e-5) << "it has come to rest by then";
    BodyTrack fan = wheel_of_car(66, 60);
    for (BodyPose& pose : fan.keys) {
        pose.translation = Vec3(1);
    }
    EXPECT_LT(spoke_moved(fan), 1e-5) << "it stays where it is";
    BodyTrack turned = wheel_of_car(66, 60);
    std::reverse(turned.keys.begin() + 16, turned.keys.end());
    EXPECT_LT(spoke_moved(turned), 1e-5) << "it spins the other way by then";
}

TEST(BodyMotion, RestIsExactlyNoMotion) {
    BodyTrack track{3, 0, {4, {Vec3(1.1f, 2.2f, 3.3f), glm::angleAxis(0.3f, Vec3(0.6f, 0.8f, 0)), Vec3(1.7f)}}};
    EXPECT_EQ(motion_between(track, 0.01, 0.04), Motion{});
    BodyMotions motions;
    EXPECT_EQ(motions.between(static_body, 0, 1), Motion{});
    motions.extend(wheel(1, 0, 60));
    EXPECT_EQ(motions.between(8, 0, 1), Motion{});
    EXPECT_EQ(motions.between(7, 0.5, 0.5), Motion{});
    EXPECT_NE(motions.between(7, 0.25, 0.5), Motion{});
}

TEST(BodyMotion, WhatRestsIsAtOnePlaceAllTheTime) {
    // The poses are few, so that rest and coming back to where it was are both common.
    std::mt19937 random(5);
    std::uniform_int_distribution<int> pose(0, 5), keys(0, 8);
    std::uniform_int_distribution<int> half_key(-6, 28);
    int resting = 0, came_back = 0;
    for (int round = 0; round < 20000; ++round) {
        BodyTrack track{7, 0, {}};
        for (int i = keys(random); i > 0; --i) {
            track.keys.push_back({Vec3(pose(random) == 0 ? 1.0f : 0.0f, 0, 0), {1, 0, 0, 0}, Vec3(1)});
        }
        BodyMotions motions;
        motions.extend(track);
        auto const [from, to] =
            std::minmax({0.5 * half_key(random) * key_seconds, 0.5 * half_key(random) * key_seconds});
        bool moves = false;
        for (int i = 0; i <= 40; ++i) {
            moves = moves || motions.between(7, from, std::min(from + (to - from) * i / 40, to)) != Motion{};
        }
        bool const rests = motions.rests(7, from, to);
        EXPECT_FALSE(rests && moves) << from << ' ' << to;
        resting += rests ? 1 : 0;
        came_back += moves && motions.between(7, from, to) == Motion{} ? 1 : 0;
    }
    EXPECT_GT(resting, 2000);
    EXPECT_GT(came_back, 500);
    EXPECT_TRUE(BodyMotions{}.rests(7, 0, 1)) << "nothing is known of it, and nothing moves it";
}

TEST(BodyMotion, WhatDeformsOrIsOnABodyThatMovesIsNotAtRest) {
    BodyMotions motions, of_no_rest(false);
    BodyTrack track{7, 0, std::vector<BodyPose>(60)};
    for (std::size_t i = 40; i < 60; ++i) {
        track.keys[i].translation.x = static_cast<float>(i) - 39;
    }
    motions.extend(track);
    of_no_rest.extend(track);
    FrameletShape shape;
    EXPECT_TRUE(is_at_rest(shape, 0, motions));
    shape.layer_count = 1;
    shape.layers[0].body = 7;
    shape.layers[1].drift.corner.velocity.x = 1; // not one of its layers
    EXPECT_TRUE(is_at_rest(shape, 0.3, motions));
    EXPECT_FALSE(is_at_rest(shape, 0.3, of_no_rest));
    EXPECT_FALSE(is_at_rest(shape, 39 * key_seconds - 0.9 * resting_seconds, motions)) << "it soon will move";
    EXPECT_FALSE(is_at_rest(shape, 0.8, motions));
    shape.outliers.push_back({1, static_body, {Vec3(0, 1, 0)}});
    EXPECT_FALSE(is_at_rest(shape, 0.3, motions));
}

TEST(BodyMotion, DegenerateTracksAreFinite) {
    EXPECT_EQ(pose_at({}, 3), BodyPose{});
    BodyTrack flat = wheel(1, 0, 2);
    flat.keys[0].scale = Vec3(1, 0, 1);
    EXPECT_EQ(motion_between(flat, 0, 1), Motion{});
    BodyTrack spinning = wheel(66, 0, 20);
    spinning.keys[9].rotation.x = NAN;
    EXPECT_NE(motion_between(spinning, 0, 8 * key_seconds), Motion{}) << "both poses are whole";
    EXPECT_EQ(motion_between(spinning, 0, 8.5 * key_seconds), Motion{});
    EXPECT_EQ(pose_at({1, 5, {BodyPose{Vec3(1)}}}, 1).translation, Vec3(1));
}

/// A viewer's memory is its own, whatever a server says.
TEST(BodyMotion, TheKeysOfAllBodiesTogetherAreBounded) {
    BodyMotions motions;
    EXPECT_EQ(motions.kept_keys(), kept_track_keys);
    constexpr int bodies = 65535, keys = 1024;
    BodyTrack track = wheel(1, 0, keys);
    for (std::int64_t round = 0; round < 2; ++round) {
        track.first_key = round * keys;
        for (int body = 1; body <= bodies; body += body < 3000 || round == 0 ? 1 : 100) {
            track.body = static_cast<BodyNumber>(body);
            motions.extend(track);
        }
    }
    std::size_t held = 0, taken = 0;
    for (int body = 1; body <= bodies; ++body) {
        BodyTrack const* const known = motions.find(static_cast<BodyNumber>(body));
        ASSERT_NE(known, nullptr);
        held += known->keys.size();
        taken += known->keys.capacity();
    }
    EXPECT_LE(held, most_kept_keys);
    EXPECT_LE(taken, 2 * most_kept_keys);
    EXPECT_EQ(motions.kept_keys(), 32u);
    BodyTrack const* const newest = motions.find(1);
    EXPECT_EQ(newest->first_key + static_cast<std::int64_t>(newest->keys.size()), 2 * keys) << "the last ones are kept";
    EXPECT_EQ(newest->keys.back(), track.keys.back());
}

TEST(BodyMotion, AThousandBodiesKeepAllTheyWouldAlone) {
    BodyMotions motions;
    BodyTrack track = wheel(1, 0, 10);
    for (int body = 1; body <= 1024; ++body) {
        track.body = static_cast<BodyNumber>(body);
        motions.extend(track);
    }
    EXPECT_EQ(motions.kept_keys(), kept_track_keys);
}

} // namespace
} // namespace framelet
