#include "server/render/light/split_sum.h"

#include <cmath>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(SplitSum, NeverReflectsMoreThanArrives) {
    SplitSumTable const table;
    for (float cosine = 0; cosine <= 1; cosine += 0.05f) {
        for (float roughness = 0; roughness <= 1; roughness += 0.05f) {
            Vec2 const v = table.at(cosine, roughness);
            EXPECT_GE(v.x, 0);
            EXPECT_GE(v.y, 0);
            EXPECT_LE(v.x + v.y, 1.0001f);
        }
    }
}

TEST(SplitSum, KnownValues) {
    SplitSumTable const table;
    // A smooth mirror reflects f0 + (1 - f0)(1 - cos)^5.
    EXPECT_NEAR(table.at(1, 0).x, 1, 0.01);
    EXPECT_NEAR(table.at(1, 0).y, 0, 0.01);
    EXPECT_NEAR(table.at(0.5f, 0).y, 1.0f / 32, 0.01);
    // At roughness 1 under normal incidence it is the integral of x / (1 + x) over the cosine x.
    Vec2 const rough = table.at(1, 1);
    EXPECT_NEAR(rough.x + rough.y, 1 - std::log(2.0f), 0.002f);
}

TEST(SplitSum, WhiteSurfacesReturnEverything) {
    SplitSumTable const table;
    for (float cosine : {0.1f, 0.5f, 1.0f}) {
        for (float roughness : {0.0f, 0.5f, 1.0f}) {
            AmbientShares const metal = ambient_shares(table.at(cosine, roughness), Vec3(1), Vec3(0));
            EXPECT_NEAR(metal.specular.g + metal.diffuse.g, 1, 1e-5f);
            AmbientShares const plastic = ambient_shares(table.at(cosine, roughness), Vec3(0.04f), Vec3(1));
            EXPECT_NEAR(plastic.specular.g + plastic.diffuse.g, 1, 1e-5f);
        }
    }
}

} // namespace
} // namespace framelet
