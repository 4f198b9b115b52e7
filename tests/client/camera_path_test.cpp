#include "client/core/camera/camera_path.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "common/error.h"

namespace framelet {
namespace {

TEST(CameraPath, OneKeyStandsStill) {
    CameraPath const path =
        parse_camera_path(R"({"position":[1,2,3],"target":[0,0,0],"up":[0,2,0],"fov_degrees":60})", "test");
    Camera const camera = look_at({1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 60 * 3.14159265f / 180);
    for (double const time : {0.0, 5.0, 1e9}) {
        EXPECT_EQ(path.at(time).position, camera.position);
        EXPECT_NEAR(path.at(time).vertical_extent, camera.vertical_extent, 1e-5f);
        EXPECT_GT(glm::dot(path.at(time).forward(), camera.forward()), 0.99999f);
    }
    EXPECT_EQ(path.duration(), 0);
    EXPECT_EQ(path.scene_camera, -1);
}

TEST(CameraPath, ScenesFarAwayHaveExactCameras) {
    glm::dvec3 const origin(1842016, 0, -5173312);
    CameraPath const path = parse_camera_path(R"({"keys":[
        {"time":0,"position":[1842022.125,10,-5173301.0625],"target":[1842022.125,10,-5173302]},
        {"time":1,"position":[1842024.125,10,-5173301.0625],"target":[1842024.125,10,-5173302]}]})",
                                              "test");
    EXPECT_EQ(path.at(0, origin).position, Vec3(6.125f, 10, 10.9375f));
    EXPECT_LT(glm::distance(path.at(0.5, origin).position, Vec3(7.125f, 10, 10.9375f)), 1e-5f);
    EXPECT_LT(glm::distance(path.at(0.5, origin).forward(), Vec3(0, 0, -1)), 1e-5f);
}

CameraPath flight() {
    return parse_camera_path(R"({"keys":[
        {"time":1,"position":[0,1,5],"target":[0,0,0]},
        {"time":2,"position":[3,1,4],"target":[0,0,0],"fov_degrees":30},
        {"time":5,"position":[6,2,0],"target":[1,0,0]},
        {"time":6,"position":[6,2,-4],"target":[1,0,0],"up":[1,1,0]}]})",
                             "test");
}

TEST(CameraPath, PassesThroughItsKeysAndStandsOutsideThem) {
    CameraPath const path = flight();
    ASSERT_EQ(path.keys.size(), 4u);
    EXPECT_EQ(path.duration(), 6);
    for (CameraKey const& key : path.keys) {
        Camera const camera = path.at(key.time);
        EXPECT_LT(glm::distance(camera.position, Vec3(key.position)), 1e-4f);
        EXPECT_NEAR(camera.vertical_extent, key.vertical_fov, 1e-4f);
        EXPECT_GT(glm::dot(camera.forward(), glm::normalize(Vec3(key.target - key.position))), 0.9999f);
    }
    EXPECT_EQ(path.at(0).position, path.at(1).position);
    EXPECT_EQ(path.at(100).position, path.at(6).position);
}

TEST(CameraPath, MovesWithoutJumpsInPlaceAndSpeed) {
    CameraPath const path = flight();
    constexpr double step = 1e-3;
    Vec3 last_speed(0);
    for (double time = 1 + step; time < 6 - 2 * step; time += step) {
        Vec3 const speed = (path.at(time + step).position - path.at(time).position) / static_cast<float>(step);
        EXPECT_LT(glm::length(speed), 10);
        if (time > 1.5 * step + 1) {
            EXPECT_LT(glm::distance(speed, last_speed), 0.2f) << time;
        }
        last_speed = speed;
        ASSERT_TRUE(is_valid(path.at(time)));
    }
}

TEST(CameraPath, BetweenEqualKeysItStandsStill) {
    CameraPath const path = parse_camera_path(R"({"keys":[
        {"time":0,"position":[0,1,5],"target":[0,0,0]},
        {"time":1,"position":[3,1,4],"target":[0,0,0]},
        {"time":2,"position":[3,1,4],"target":[0,0,0]},
        {"time":3,"position":[6,2,0],"target":[1,0,0]}]})",
                                              "test");
    for (double time = 1; time < 2; time += 0.01) {
        EXPECT_EQ(path.at(time).position, path.at(1).position) << time;
        EXPECT_EQ(path.at(time).orientation, path.at(1).orientation) << time;
    }
    for (double const time : {1.0, 2.0}) { // and comes there and leaves without a jump in its speed
        EXPECT_LT(glm::distance(path.at(time - 1e-3).position, path.at(time + 1e-3).position), 1e-4f);
    }
}

TEST(CameraPath, WhereTheLastKeysAreEqualItHasCome) {
    CameraPath const path = parse_camera_path(R"({"keys":[
        {"time":0,"position":[0,1,5],"target":[0,0,0]},
        {"time":1,"position":[3,1,4],"target":[0,0,0]},
        {"time":5,"position":[3,1,4],"target":[0,0,0]}]})",
                                              "test");
    for (double time = 1; time < 6; time += 0.01) {
        EXPECT_EQ(path.at(time), path.at(5)) << time;
    }
}

TEST(CameraPath, ACameraOfTheScene) {
    EXPECT_EQ(parse_camera_path(R"({"scene_camera": 2})", "test").scene_camera, 2);
}

TEST(CameraPath, AnyMayBeOfAMoment) {
    for (std::string const camera : {R"("position":[1,2,3],"target":[0,0,0])", R"("scene_camera":0)",
                                     R"("keys":[{"time":1,"position":[1,2,3],"target":[0,0,0]}])"}) {
        CameraMoment const bare = parse_camera_path("{" + camera + "}", "test").moment;
        EXPECT_EQ(bare, CameraMoment()) << camera;
        EXPECT_EQ(bare.clock_request().set, 0);
        CameraMoment const moment =
            parse_camera_path("{" + camera + R"(,"scene_time":12.5,"paused":true,"exposure":-1.5})", "test").moment;
        EXPECT_EQ(moment, (CameraMoment{12.5, true, -1.5f})) << camera;
        ClockRequest const request = moment.clock_request();
        EXPECT_EQ(request.set, ClockRequest::time | ClockRequest::playing);
        EXPECT_EQ(request.state.time, 12.5);
        EXPECT_FALSE(request.state.playing);
    }
    EXPECT_TRUE(CameraMoment{.paused = false}.clock_request().state.playing);
}

TEST(CameraPath, AnOrthographicCameraStandsStill) {
    Camera const camera =
        parse_camera_path(R"({"position":[1,2,3],"target":[0,0,0],"orthographic_height":2.5})", "test").at(7);
    EXPECT_EQ(camera.projection, Projection::orthographic);
    EXPECT_EQ(camera.vertical_extent, 2.5f);
}

TEST(CameraPath, CurvesThatCrossStillGiveACamera) {
    CameraPath const path = parse_camera_path(R"({"keys":[
        {"time":0,"position":[0,0,1],"target":[0,0,-1]},{"time":1,"position":[0,0,-1],"target":[0,0,1]}]})",
                                              "test");
    for (int i = 0; i <= 100; ++i) {
        EXPECT_TRUE(is_valid(path.at(i / 100.0))) << i;
    }
}

TEST(CameraPath, BadContentGetsOneLineThatNamesTheFile) {
    char const* const cases[] = {
        "",
        "{",
        "[]",
        "3",
        "{}",
        R"({"position":[1,2],"target":[0,0,0]})",
        R"({"position":[1,2,"x"],"target":[0,0,0]})",
        R"({"position":[1,2,1e300],"target":[0,0,0]})",
        R"({"position":[1,2,3]})",
        R"({"position":[1,2,3],"target":[1,2,3]})",
        R"({"position":[1,2,3],"target":[0,0,0],"up":[0,0,0]})",
        R"({"position":[1,2,3],"target":[0,0,0],"fov_degrees":180})",
        R"({"position":[1,2,3],"target":[0,0,0],"fov_degrees":"wide"})",
        R"({"position":[1,2,3],"target":[0,0,0],"colour":1})",
        R"({"position":[1,2,3],"target":[0,0,0],"orthographic_height":0})",
        R"({"position":[1,2,3],"target":[0,0,0],"orthographic_height":1,"fov_degrees":45})",
        R"({"keys":[{"time":1,"position":[1,2,3],"target":[0,0,0],"orthographic_height":1}]})",
        R"({"position":[1,2,3],"target":[0,0,0],"scene_time":-1})",
        R"({"position":[1,2,3],"target":[0,0,0],"paused":1})",
        R"({"position":[1,2,3],"target":[0,0,0],"exposure":"bright"})",
        R"({"keys":[{"time":1,"position":[1,2,3],"target":[0,0,0],"scene_time":1}]})",
        R"({"scene_time":1})",
        R"({"scene_camera":-1})",
        R"({"scene_camera":1.5})",
        R"({"scene_camera":0,"position":[1,2,3]})",
        R"({"position":[1e999,2,3],"target":[0,0,0]})",
        R"({"position":[NaN,2,3],"target":[0,0,0]})",
        R"({"position":[1,2,3],"target":[0,0,0],"fov_degrees":-1e999})",
        R"({"keys":[]})",
        R"({"keys":{}})",
        R"({"keys":[7]})",
        R"({"keys":[{"position":[1,2,3],"target":[0,0,0]}]})",
        R"({"keys":[{"time":1,"position":[1,2,3],"target":[0,0,0]},{"time":1,"position":[1,2,3],"target":[0,0,0]}]})",
        R"({"keys":[{"time":-1,"position":[1,2,3],"target":[0,0,0]}]})",
    };
    for (char const* const text : cases) {
        try {
            parse_camera_path(text, "some/file.json");
            ADD_FAILURE() << text;
        } catch (InputError const& error) {
            std::string const line = error.what();
            EXPECT_NE(line.find("some/file.json"), std::string::npos) << line;
            EXPECT_EQ(line.find('\n'), std::string::npos) << line;
        }
    }
    EXPECT_THROW(read_camera_path("/nonexistent/camera.json"), InputError);
    EXPECT_THROW(read_camera_path("/"), InputError);
}

} // namespace
} // namespace framelet
