#include "server/stream/camera_forecast.h"

#include <cmath>
#include <random>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

namespace framelet {
namespace {

constexpr double frame = 1.0 / 60;

Camera camera_at(Vec3 position, float angle = 0) {
    Camera camera;
    camera.position = position;
    camera.orientation = glm::angleAxis(angle, Vec3(0, 1, 0));
    return camera;
}

TEST(CameraForecast, GoesOnAsItDoes) {
    CameraForecast forecast;
    auto const at = [](double time) {
        auto const t = static_cast<float>(time);
        return camera_at({3 * t, -t, 0}, 0.5f * t);
    };
    for (int i = 0; i <= 30; ++i) {
        forecast.add(at(5 + i * frame), 5 + i * frame);
    }
    double const now = 5 + 30 * frame + 0.01;
    Camera const camera = forecast.at(now, 0.1);
    Camera const expected = at(now + 0.1);
    EXPECT_NEAR(glm::distance(camera.position, expected.position), 0, 1e-4);
    EXPECT_NEAR(std::abs(glm::dot(camera.orientation, expected.orientation)), 1, 1e-6);
}

TEST(CameraForecast, WhatBeginsStandsOrJumpsStays) {
    CameraForecast forecast;
    forecast.add(camera_at({1, 2, 3}), 0);
    EXPECT_EQ(forecast.at(0, 0.1), camera_at({1, 2, 3}));
    forecast.add(camera_at({1, 2, 4}), frame);
    EXPECT_EQ(forecast.at(frame, 0.1).position, Vec3(1, 2, 4)) << "two tell nothing";
    for (int i = 2; i < 20; ++i) {
        forecast.add(camera_at({1, 2, 4}), i * frame);
    }
    forecast.add(camera_at({100, 2, 4}, 1), 20 * frame);
    EXPECT_EQ(forecast.at(20 * frame, 0.1).position, Vec3(100, 2, 4)) << "a jump is no motion";
    CameraForecast stops;
    for (int i = 0; i < 20; ++i) {
        stops.add(camera_at({0.1f * static_cast<float>(i), 0, 0}), i * frame);
    }
    EXPECT_EQ(stops.at(19 * frame + 0.2, 0.1).position.x, 1.9f) << "it has not moved for a while";
}

TEST(CameraForecast, WhatTurnsBackIsNotLed) {
    CameraForecast forecast;
    for (int i = 0; i <= 8; ++i) {
        forecast.add(camera_at({static_cast<float>(std::abs(i - 4)), 0, 0}), i * frame);
    }
    EXPECT_EQ(forecast.at(8 * frame, 0.1).position.x, 4);
}

TEST(CameraForecast, AFloodOfCamerasIsForecastAsAFewAre) {
    CameraForecast forecast;
    for (int i = 0; i <= 300'000; ++i) { // 0.3 s; none may be gone through many times
        double const time = 1e-6 * i;
        forecast.add(camera_at({static_cast<float>(time), 0, 0}), time);
    }
    EXPECT_NEAR(forecast.at(0.3, 0.1).position.x, 0.4, 1e-4);
}

TEST(CameraForecast, AnyCamerasGiveOne) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> exponent(-12, 10), sign(-1, 1);
    for (int run = 0; run < 2000; ++run) {
        CameraForecast forecast;
        double now = 0;
        for (int i = 0; i < 12; ++i) {
            Camera camera;
            for (int axis = 0; axis < 3; ++axis) {
                camera.position[axis] = std::copysign(std::pow(10.0f, exponent(random)), sign(random));
            }
            camera.orientation = glm::normalize(Quat(sign(random), sign(random), sign(random), sign(random)));
            now += static_cast<double>(std::abs(sign(random))) * 0.03 * (i % 3);
            forecast.add(camera, now);
            ASSERT_TRUE(is_valid(forecast.at(now, 0.1)));
        }
    }
}

} // namespace
} // namespace framelet
