#include "server/render/light/environment.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "common/error.h"
#include "server/render/light/environment_filter.h"

namespace framelet {
namespace {

std::vector<Vec3> directions() {
    std::vector<Vec3> out{{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int i = 0; i < 40; ++i) {
        float const y = -0.95f + 0.05f * static_cast<float>(i);
        float const r = std::sqrt(1 - y * y);
        out.emplace_back(r * std::cos(2.4f * static_cast<float>(i)), y, r * std::sin(2.4f * static_cast<float>(i)));
    }
    return out;
}

/// A spot of light in the direction `towards`, black elsewhere.
FloatImage spot(Vec3 towards, float radiance, int width = 256) {
    FloatImage map(width, width / 2);
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            Vec2 const center((static_cast<float>(x) + 0.5f) / static_cast<float>(map.width),
                              (static_cast<float>(y) + 0.5f) / static_cast<float>(map.height));
            map.at(x, y) = Vec3(glm::dot(direction_from_equirect(center), towards) > 0.98f ? radiance : 0.0f);
        }
    }
    return map;
}

TEST(OctahedralMap, DirectionsSurviveTheRoundTrip) {
    for (Vec3 const& d : directions()) {
        EXPECT_NEAR(glm::length(direction_from_octahedral(octahedral_from_direction(d)) - d), 0, 1e-5f);
    }
}

TEST(OctahedralMap, LooksUpSmoothlyAcrossItsEdges) {
    int const side = 32;
    std::vector<Vec3> const values = octahedral_directions(side); // the map of "which way is this"
    OctahedralMap const map(side, values);
    for (Vec3 const& d : directions()) {
        EXPECT_LT(glm::length(map.sample(d) - d), 0.06f);
    }
}

TEST(Environment, MapsDirectionsAsDocumented) {
    EXPECT_NEAR(glm::length(equirect_from_direction({0, 0, -1}) - Vec2(0.5f, 0.5f)), 0, 1e-6f);
    EXPECT_NEAR(glm::length(equirect_from_direction({1, 0, 0}) - Vec2(0.75f, 0.5f)), 0, 1e-6f);
    EXPECT_NEAR(equirect_from_direction({0, 1, 0}).y, 0, 1e-6f);
    for (Vec3 const& d : directions()) {
        EXPECT_NEAR(glm::length(direction_from_equirect(equirect_from_direction(d)) - d), 0, 1e-5f);
    }
}

TEST(Environment, UniformMapStaysUniformInEveryFilter) {
    FloatImage map(64, 32);
    map.rgb.assign(map.rgb.size(), Vec3(0.7f, 1.0f, 2.0f));
    Environment const environment(map);
    for (Vec3 const& d : directions()) {
        for (Vec3 const value :
             {environment.background(d, 0), environment.background(d, 1), environment.diffuse(d),
              environment.specular(d, 0), environment.specular(d, 0.3f), environment.specular(d, 1)}) {
            EXPECT_NEAR(value.r, 0.7f, 1e-3f);
            EXPECT_NEAR(value.b, 2.0f, 3e-3f);
        }
    }
}

TEST(Environment, BrightSpotIsSeenAndLightsFromItsDirection) {
    Vec3 const towards = glm::normalize(Vec3(0.6f, 0.5f, -0.3f));
    Environment const environment(spot(towards, 100));
    EXPECT_NEAR(environment.background(towards, 0).g, 100, 1e-3f);
    EXPECT_EQ(environment.background(-towards, 0).g, 0);
    EXPECT_NEAR(environment.specular(towards, 0).g, 100, 1e-3f);
    // Irradiance / pi of a cap of radiance L: L sin^2 of its half angle.
    float const expected = 100 * (1 - 0.98f * 0.98f);
    EXPECT_NEAR(environment.diffuse(towards).g, expected, 0.05f * expected);
    EXPECT_NEAR(environment.diffuse(-towards).g, 0, 0.02f * expected);
    Vec3 const aside = glm::normalize(glm::cross(towards, Vec3(0, 1, 0)));
    Vec3 const slanted = glm::normalize(towards + aside); // 45 degrees off
    EXPECT_NEAR(environment.diffuse(slanted).g, expected * std::sqrt(0.5f), 0.06f * expected);
}

TEST(Environment, RougherLobesAreWiderAndKeepTheEnergy) {
    Vec3 const towards(0, 0, -1);
    Environment const environment(spot(towards, 100));
    float before = 101;
    for (float roughness : {0.0f, 0.2f, 0.4f, 0.6f, 0.8f, 1.0f}) {
        float const peak = environment.specular(towards, roughness).g;
        EXPECT_LT(peak, before) << roughness;
        before = peak;
    }
    Vec3 const off = glm::normalize(Vec3(0.7f, 0, -1));
    EXPECT_GT(environment.specular(off, 0.7f).g, environment.specular(off, 0.2f).g);
}

TEST(Environment, TinyBrightSunLightsSmoothly) {
    FloatImage map(1024, 512);
    map.at(600, 180) = Vec3(65504);
    map.at(3, 7) = Vec3(NAN, INFINITY, -5);
    Environment const environment(map);
    for (float roughness : {0.35f, 0.5f, 1.0f}) {
        // No speckles: a step of a degree changes what a rough mirror shows by little.
        Vec3 const sun = direction_from_equirect({600.5f / 1024, 180.5f / 512});
        float brightest = 0, largest_step = 0, before = environment.specular(sun, roughness).g;
        for (int i = 1; i < 180; ++i) {
            float const angle = static_cast<float>(i) * 0.0174533f;
            Vec3 const aside = glm::normalize(glm::cross(sun, Vec3(0, 1, 0)));
            float const value = environment.specular(sun * std::cos(angle) + aside * std::sin(angle), roughness).g;
            EXPECT_TRUE(std::isfinite(value) && value >= 0);
            largest_step = std::max(largest_step, std::abs(value - before));
            brightest = std::max({brightest, value, before});
            before = value;
        }
        EXPECT_LT(largest_step, 0.2f * brightest) << roughness;
        EXPECT_GT(brightest, 0);
    }
    EXPECT_TRUE(std::isfinite(environment.background(direction_from_equirect({3.5f / 1024, 7.5f / 512}), 0).g));
}

TEST(Environment, SunOfOneClippedChannelIsWhite) {
    FloatImage map(64, 32);
    map.rgb.assign(map.rgb.size(), Vec3(0.1f, 0.2f, 0.5f));
    map.at(20, 8) = Vec3(0, 0, 5000);
    map.at(50, 20) = Vec3(0, 0, 3); // a blue lamp stays blue
    Environment const environment(map);
    EXPECT_EQ(environment.background(direction_from_equirect({20.5f / 64, 8.5f / 32}), 0).r, 5000);
    EXPECT_NEAR(environment.background(direction_from_equirect({50.5f / 64, 20.5f / 32}), 0).r, 0, 1e-3f);
}

TEST(Environment, DefaultSkyIsBlueAboveAndNeutralBelow) {
    Environment const sky = Environment::default_sky();
    Vec3 const up = sky.background({0, 1, 0}, 0);
    Vec3 const down = sky.background({0, -1, 0}, 0);
    EXPECT_GT(up.b, 2 * up.r);
    EXPECT_LT(down.b / down.r, 1.1f);
    EXPECT_GT(sky.diffuse({0, 1, 0}).g, sky.diffuse({0, -1, 0}).g);
}

TEST(Environment, MissingFileIsAnInputError) {
    EXPECT_THROW(Environment::load("/nowhere/sky.hdr"), InputError);
}

} // namespace
} // namespace framelet
