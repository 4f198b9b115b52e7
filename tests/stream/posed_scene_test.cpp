// What a scene learns of its light while nobody looks at it.
#include "server/stream/posed_scene.h"

#include <gtest/gtest.h>

#include "server/render/path/path_picture.h"
#include "server/render/picture_renderer.h"
#include "tests/render/box_scene.h"

namespace framelet {
namespace {

using namespace test;

/// A room of two halves, with a lamp in each. Its camera sees one of them, and the doorway to the other.
struct TwoRooms {
    Scene scene = cube(matte(Vec3(0.7f)));
    RenderScene ready;
    static Camera first() { return look_at({0.9f, 0.5f, 0.15f}, {0.6f, 0.4f, 0.9f}, {0, 1, 0}, 1); }
    static Camera beyond() { return look_at({0.4f, 0.5f, 0.4f}, {0.05f, 0.4f, 0.05f}, {0, 1, 0}, 1); }

    TwoRooms() : ready(furnish(scene), black()) {}

    static Scene const& furnish(Scene& scene) {
        scene.materials.push_back(matte({0.2f, 0.2f, 0.7f}));
        add(scene, quad({0.5f, 0, 0}, {0, 0, 0.6f}, {0, 1, 0}, 1));
        add(scene, quad({0.5f, 0, 0.6f}, {0, 0, -0.6f}, {0, 1, 0}, 1));
        Light lamp;
        lamp.type = LightType::point;
        for (float const x : {0.25f, 0.75f}) {
            lamp.intensity = x < 0.5f ? 2.0f : 0.5f;
            add_light(scene, lamp, {x, 0.8f, 0.3f}, {0, -1, 0});
        }
        Node eye;
        eye.local.translation = first().position;
        eye.local.rotation = first().orientation;
        scene.nodes.push_back(eye);
        scene.cameras.push_back({"eye", static_cast<Index>(scene.nodes.size() - 1), Projection::perspective, 1});
        return scene;
    }
};

/// The light of a view as it is shown at once, off what paths find: mean of absolute differences, relative.
double error_of(RenderScene const& scene, Camera const& camera, FloatImage const& truth) {
    FloatImage const shown = render_radiance(scene, camera, {truth.width, truth.height}, 1);
    double off = 0, all = 0;
    for (std::size_t i = 0; i < truth.rgb.size(); ++i) {
        off += std::abs(double(shown.rgb[i].g - truth.rgb[i].g));
        all += double(truth.rgb[i].g);
    }
    return off / all;
}

LightOptions full_light() {
    LightOptions light;
    light.method = LightMethod::full;
    light.lamp_metres = 0.0f;
    return light;
}

TEST(PosedScene, LearnsLightWhereNobodyHasLookedYet) {
    TwoRooms rooms;
    PathOptions paths;
    paths.paths = 1024;
    FloatImage const truth = render_paths(rooms.ready, TwoRooms::beyond(), {24, 16}, paths);
    auto const error_after = [&](int slices) {
        PosedScene posed(rooms.scene, {}, rooms.ready, full_light());
        for (int i = 0; i < slices; ++i) {
            posed.learn_light();
        }
        return error_of(rooms.ready, TwoRooms::beyond(), truth);
    };
    double const before = error_after(0);
    EXPECT_GT(before, 0.1);
    int slices = 500; // of time: how many paths these are is the machine's
    while (error_after(slices) > 0.08 && slices < 16'000) {
        slices *= 2;
    }
    EXPECT_LT(slices, 16'000) << before;
}

TEST(PosedScene, HasLearntAllInTheEnd) {
    Scene scene;
    scene.materials.push_back(matte(Vec3(0.5f)));
    add(scene, quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, 0));
    RenderScene ready(scene, Environment::uniform(Vec3(1)));
    PosedScene posed(scene, {}, ready, full_light());
    int slices = 0;
    for (; slices < 10'000 && posed.learn_light(); ++slices) {
    }
    EXPECT_GT(slices, 32) << "views, and paths between them";
    EXPECT_LT(slices, 10'000);
    EXPECT_FALSE(posed.light_gathering()->is_learning());
}

TEST(PosedScene, HasNothingToLearnOfDirectLight) {
    TwoRooms rooms;
    PosedScene posed(rooms.scene, {}, rooms.ready);
    EXPECT_FALSE(posed.learn_light());
}

} // namespace
} // namespace framelet
