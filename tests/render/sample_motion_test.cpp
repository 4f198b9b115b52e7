#include "server/render/trace/sample_motion.h"

#include <random>

#include <gtest/gtest.h>

#include "scene_builder.h"

namespace framelet {
namespace {

using namespace test;

std::vector<Index> const clips{0};
ImagePlane const plane({32, 32});
Camera const camera = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 0.5f);
Tile const centre = make_tile(plane.pixel_depth(), 0, 0);

void animate(Scene& scene, Index node, AnimatedProperty property, std::vector<float> values) {
    scene.clips.resize(1);
    scene.clips[0].duration = 2;
    int const components = static_cast<int>(values.size()) / 2;
    scene.clips[0].channels.push_back({node, property, Interpolation::linear, components, {0, 2}, std::move(values)});
}

/// Renders the quarter of the picture above and left of the middle, at a time of the scene's clips.
Framelet render(Scene const& scene, SceneTime time) {
    RenderScene ready(scene, black());
    ready.set_clips(clips);
    ready.set_pose(evaluate_pose(scene, clips, time));
    Framelet framelet;
    render_framelet(ready, make_view_rays(camera, plane.viewport()), plane, centre, framelet);
    return framelet;
}

Primitive wall(float left, float width, Index material = 0) {
    return quad({left, -10, 0}, {width, 0, 0}, {0, 20, 0}, material);
}

TEST(SampleMotion, SamplesTellTheirBody) {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    add(scene, wall(-20, 18.6f)); // left of x = -1.4
    Index const node = add(scene, wall(-1.4f, 20));
    animate(scene, node, AnimatedProperty::translation, {0, 0, 0, 0, 4, 0});
    Framelet const framelet = render(scene, 0.25);
    ASSERT_EQ(framelet.body.size(), std::size_t{framelet_samples});
    EXPECT_TRUE(framelet.drift.empty());
    EXPECT_TRUE(framelet.reflects.none());
    int moving = 0;
    float const pixel = 2 * std::tan(0.25f) / 32 * 10;
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        bool const right = (static_cast<float>(morton_x(i)) + 0.5f - 16) * pixel > -1.4f;
        EXPECT_EQ(framelet.body[i], right ? 1 : 0) << i;
        moving += right ? 1 : 0;
    }
    EXPECT_GT(moving, 16);
    EXPECT_LT(moving, framelet_samples);
}

TEST(SampleMotion, NothingIsKeptWhereNothingMoves) {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    add(scene, wall(-20, 40));
    Index const elsewhere = add(scene, quad({50, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0));
    animate(scene, elsewhere, AnimatedProperty::translation, {0, 0, 0, 0, 4, 0});
    Framelet const framelet = render(scene, 0.25);
    EXPECT_TRUE(framelet.body.empty());
    EXPECT_TRUE(framelet.drift.empty());
}

/// Where a body takes a point of the world from one time to another.
Vec3 carried(Scene const& scene, BodyNumber body, Vec3 const& point, SceneTime from, SceneTime to) {
    SceneBodies const bodies = find_bodies(scene, clips);
    BodyPose const before = body_pose(bodies, evaluate_pose(scene, clips, from), body);
    BodyPose const after = body_pose(bodies, evaluate_pose(scene, clips, to), body);
    Vec3 const in_body = (glm::conjugate(before.rotation) * (point - before.translation)) / before.scale;
    return after.rotation * (after.scale * in_body) + after.translation;
}

TEST(SampleMotion, WhatShearsDriftsBesidesItsBodyAsItsTransformSays) {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    Index const node = add(scene, wall(-20, 40)) + 1;
    Node stretching;
    scene.nodes.insert(scene.nodes.begin(), stretching);
    scene.nodes[1].parent = 0;
    // The node is stretched by one axis above something that is turned about the view axis.
    animate(scene, 0, AnimatedProperty::scale, {1, 1, 1, 1, 2, 1});
    animate(scene, node, AnimatedProperty::rotation, {0, 0, 0, 1, 0, 0, 0.3f, 0.9539392f});
    constexpr double time = 1;
    Framelet const framelet = render(scene, time);
    ASSERT_EQ(framelet.body.size(), std::size_t{framelet_samples});
    ASSERT_EQ(framelet.drift.size(), std::size_t{framelet_samples});
    auto const world = [&](SceneTime at) {
        return evaluate_pose(scene, clips, at).world_from_node[static_cast<std::size_t>(node)];
    };
    float const pixel = 2 * std::tan(0.25f) / 32 * 10;
    float fastest = 0;
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        Vec3 const point((static_cast<float>(morton_x(i)) + 0.5f - 16) * pixel,
                         (16 - 0.5f - static_cast<float>(morton_y(i))) * pixel, 0);
        Vec4 const local = glm::inverse(world(time)) * Vec4(point, 1);
        for (float const seconds : {-motion_step, motion_step}) {
            SceneTime const then = time + static_cast<double>(seconds);
            Vec3 const shown = carried(scene, framelet.body[i], point, time, then) + framelet.drift[i].after(seconds);
            EXPECT_LT(glm::distance(shown, Vec3(world(then) * local)), 1e-4f) << i;
        }
        fastest = std::max(fastest, glm::length(framelet.drift[i].velocity));
    }
    EXPECT_GT(fastest, 0.01f) << "no body shears";
}

Scene morphing_scene() {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    Primitive primitive = wall(-20, 40);
    primitive.morph_targets.resize(1);
    primitive.morph_targets[0].positions.assign(4, Vec3(0, 0, -3));
    Index const node = add(scene, std::move(primitive));
    animate(scene, node, AnimatedProperty::morph_weights, {0, 1});
    animate(scene, node, AnimatedProperty::translation, {0, 0, 0, 1, 0, 0});
    return scene;
}

TEST(SampleMotion, WhatMorphsDriftsAsItsVerticesGoBesidesItsBody) {
    Scene const scene = morphing_scene();
    for (double const time : {0.0, 1.0, 1.999, 2.5}) { // also where the clip is about to start over
        Framelet const framelet = render(scene, time);
        ASSERT_EQ(framelet.drift.size(), std::size_t{framelet_samples});
        EXPECT_EQ(framelet.body, std::vector<BodyNumber>(framelet_samples, 1)) << "which goes by 0.5 a second";
        for (Drift const& drift : framelet.drift) {
            EXPECT_NEAR(drift.velocity.x, 0, 1e-3f);
            EXPECT_NEAR(drift.velocity.z, -1.5f, 1e-3f);
            EXPECT_LT(glm::length(drift.acceleration), 0.05f);
            EXPECT_GE(drift.jerk, least_jerk) << "nobody knows how it goes on";
        }
    }
}

TEST(SampleMotion, SkinnedVerticesMoveWithTheirJoints) {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    Primitive primitive = wall(-20, 40);
    primitive.influences.assign(4, {{0, 0, 0, 0}, {1, 0, 0, 0}});
    Index const node = add(scene, std::move(primitive));
    scene.nodes.emplace_back(); // the joint
    scene.skins.push_back({{1}, {Mat4(1)}});
    scene.nodes[static_cast<std::size_t>(node)].skin = 0;
    animate(scene, 1, AnimatedProperty::translation, {0, 0, 0, 4, 0, -2});
    Framelet const framelet = render(scene, 0.5);
    EXPECT_EQ(framelet.body, std::vector<BodyNumber>(framelet_samples, 1));
    ASSERT_EQ(framelet.drift.size(), std::size_t{framelet_samples});
    EXPECT_EQ(framelet.drift[9].velocity, Vec3(0)) << "it goes with its joint";
}

/// Two joints, of which the second turns; the middle of the wall is of both.
TEST(SampleMotion, EachTriangleGoesWithTheJointThatMovesItMost) {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    Primitive primitive = wall(-20, 40);
    JointInfluence const first{{0, 1, 0, 0}, {0.9f, 0.1f, 0, 0}}, second{{1, 0, 0, 0}, {0.6f, 0.4f, 0, 0}};
    primitive.influences = {first, second, second, first};
    std::size_t counts[2] = {};
    for (auto const& triangle : primitive.triangles) {
        float weights[2] = {};
        for (std::uint32_t const corner : triangle) {
            JointInfluence const& influence = primitive.influences[corner];
            weights[influence.joints[0]] += influence.weights[0];
            weights[influence.joints[1]] += influence.weights[1];
        }
        std::size_t const joint = joint_of(primitive, triangle);
        EXPECT_GT(weights[joint], weights[1 - joint]);
        ++counts[joint];
    }
    EXPECT_EQ(counts[0] + counts[1], primitive.triangles.size());
}

TEST(SampleMotion, DriftsGoThroughTheTimesThatAreUsable) {
    // x = 3 t + 5 t^2 + 2 t^3
    auto const at = [](float t) { return Vec3(3 * t + 5 * t * t + 2 * t * t * t, 0, 0); };
    Course off;
    std::ranges::transform(motion_seconds, off.begin(), at);
    Drift const drift = drift_of(off, {true, true, true, true}, 1e-7f);
    for (float const seconds : {-motion_step, motion_step}) {
        EXPECT_NEAR(drift.after(seconds).x, at(seconds).x, 1e-6f);
    }
    EXPECT_NEAR(drift.jerk, 12, 0.05f) << "the third derivative";
    for (float const seconds : {-0.3f, -0.1f, 0.02f, 0.1f, 0.3f}) {
        EXPECT_LE(std::abs(drift.after(seconds).x - at(seconds).x),
                  1.001f * drift.jerk * std::pow(std::abs(seconds), 3.0f) / 6 + 1e-5f +
                      0.2f * motion_step * motion_step * std::abs(seconds) * drift.jerk);
    }
    EXPECT_NEAR(drift_of(off, {false, true, true, true}, 1e-7f).velocity.x, 3, 0.05f) << "the scene has just jumped";
    EXPECT_NEAR(drift_of(off, {true, false, false, false}, 1e-7f).velocity.x, 2.755f, 1e-3f) << "and is about to";
    EXPECT_EQ(drift_of(off, {false, false, false, false}, 1e-7f), Drift{});
    EXPECT_EQ(drift_of({}, {true, true, true, true}, 1e-7f), Drift{});
    for (float const bad : {INFINITY, -INFINITY, NAN, 3e38f}) {
        for (std::size_t k = 0; k < motion_times; ++k) {
            Course broken = off;
            broken[k].y = bad;
            for (unsigned bits = 0; bits < 16; ++bits) {
                Drift const found =
                    drift_of(broken, {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0}, 1e-7f);
                EXPECT_TRUE(std::isfinite(found.velocity.y + found.acceleration.y + found.jerk));
            }
        }
    }
}

TEST(SampleMotion, WhatSwingsOrGoesRoundIsFollowedAsItDoes) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> axis(-1, 1), rate_of(0.5f, 15), phase_of(0, 6.28f);
    for (int trial = 0; trial < 1000; ++trial) {
        Vec3 const cosine(axis(random), axis(random), axis(random));
        bool const is_swing = trial % 2 == 0; // to and fro, else on an ellipse
        Vec3 const sine = is_swing ? Vec3(0) : Vec3(axis(random), axis(random), axis(random));
        float const rate = rate_of(random), start = phase_of(random);
        auto const place = [&](float t) {
            return std::cos(rate * t + start) * cosine + std::sin(rate * t + start) * sine;
        };
        Course off;
        std::ranges::transform(motion_seconds, off.begin(), [&](float t) { return place(t) - place(0); });
        Drift const drift = drift_of(off, {true, true, true, true}, 1e-6f);
        float const size = glm::length(cosine) + glm::length(sine);
        for (float const seconds : {-0.1f, 0.02f, 0.1f, 0.2f, 0.3f}) {
            float const missed = glm::distance(drift.after(seconds), place(seconds) - place(0));
            float const allowed = drift.jerk * std::pow(std::abs(seconds), 3.0f) / 6;
            EXPECT_LE(missed, 1.5f * allowed + 2e-3f * size) << "rate " << rate << ", after " << seconds;
        }
        EXPECT_LE(drift.jerk, 0.1f * rate * rate * rate * size + 0.01f) << "a parabola's is the rate cubed; " << rate;
    }
}

TEST(SampleMotion, DriftIsAFunctionOfTimeAlone) {
    Scene scene = morphing_scene();
    scene.clips[0].channels[0].times = {1, 2}; // at rest for a second, then it moves
    RenderScene ready(scene, black());
    ready.set_clips(clips);
    Framelet framelet, again;
    auto const render_at = [&](double time, Framelet& out) {
        ready.set_pose(evaluate_pose(scene, clips, time));
        render_framelet(ready, make_view_rays(camera, plane.viewport()), plane, centre, out);
    };
    render_at(1.5, framelet);
    render_at(0.2, again);
    ASSERT_FALSE(again.drift.empty());
    EXPECT_NEAR(again.drift[0].velocity.z, 0, 1e-4f);
    render_at(1.5, again);
    EXPECT_EQ(framelet.drift, again.drift);
    EXPECT_NEAR(again.drift[0].velocity.z, -3, 1e-3f);
}

TEST(SampleMotion, MirrorsAreMarkedAndSeeThroughSamplesFollowTheHeaviestSurface) {
    Scene scene;
    Material mirror = matte(Vec3(0.9f)), pane = matte(Vec3(0.5f)), rough = matte(Vec3(0.9f));
    mirror.metallic = rough.metallic = 1;
    mirror.roughness = 0.05f;
    rough.roughness = 0.6f;
    pane.alpha_mode = AlphaMode::blend;
    pane.base_color.a = 0.2f;
    scene.materials = {rough, mirror, pane};
    add(scene, wall(-20, 18.6f));
    Index const node = add(scene, wall(-1.4f, 20, 1));
    add(scene, quad({-10, -10, 2}, {20, 0, 0}, {0, 20, 0}, 2));
    animate(scene, node, AnimatedProperty::translation, {0, 0, 0, 0, 4, 0});
    Framelet const framelet = render(scene, 0.25);
    ASSERT_FALSE(framelet.body.empty());
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        EXPECT_EQ(framelet.reflects[i], framelet.body[i] == 1) << i;
        EXPECT_NEAR(framelet.depth[i], 10, 1e-3f);
    }
    EXPECT_TRUE(framelet.reflects.any());
    EXPECT_FALSE(framelet.reflects.all());
}

} // namespace
} // namespace framelet
