#include "common/color.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(Color, SrgbKnownValues) {
    // [IEC 61966-2-1]: linear 0.214041 encodes to 0.5; 0.0031308 is the joint.
    EXPECT_NEAR(srgb_from_linear(0.21404114f), 0.5f, 1e-5);
    EXPECT_NEAR(srgb_from_linear(1), 1, 1e-6);
    EXPECT_NEAR(srgb_from_linear(0.0031308f), 0.04045f, 1e-5);
    EXPECT_NEAR(linear_from_srgb(0.5f), 0.21404114f, 1e-5);
}

TEST(Color, BytesSurviveTheRoundTrip) {
    for (int byte = 0; byte < 256; ++byte) {
        auto const encoded = static_cast<std::uint8_t>(byte);
        EXPECT_EQ(srgb_byte_from_linear(linear_from_srgb_byte(encoded)), encoded);
    }
}

TEST(Color, ByteTableIsTheRoundedCurve) {
    for (int i = 0; i <= 100000; ++i) {
        float const linear = static_cast<float>(i) / 100000;
        float const exact = 255 * srgb_from_linear(linear);
        EXPECT_NEAR(srgb_byte_from_linear(linear), exact, 0.61f) << linear;
    }
}

TEST(Color, ByteOfAnythingIsDefined) {
    EXPECT_EQ(srgb_byte_from_linear(NAN), 0);
    EXPECT_EQ(srgb_byte_from_linear(-1), 0);
    EXPECT_EQ(srgb_byte_from_linear(INFINITY), 255);
    EXPECT_EQ(srgb_byte_from_linear(2), 255);
}

TEST(Color, ToneCurveStaysInRangeAndIsMonotonic) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> exponent(-20, 20);
    for (int i = 0; i < 200000; ++i) {
        Vec3 const color(std::exp2(exponent(random)), std::exp2(exponent(random)), std::exp2(exponent(random)));
        Vec3 const mapped = tone_map(color);
        for (int c = 0; c < 3; ++c) {
            ASSERT_TRUE(mapped[c] >= 0 && mapped[c] <= 1) << color.x << ' ' << color.y << ' ' << color.z;
        }
    }
    float previous = -1;
    for (float grey = 0; grey < 100; grey += 0.01f) {
        float const mapped = tone_map(Vec3(grey)).x;
        ASSERT_GE(mapped, previous);
        previous = mapped;
    }
}

TEST(Color, ToneCurveLeavesBaseColoursAlone) {
    // PBR Neutral subtracts 0.04 (the Fresnel part of a dielectric) and nothing else below 0.8.
    Vec3 const mapped = tone_map(Vec3(0.5f, 0.3f, 0.2f));
    EXPECT_NEAR(mapped.r, 0.46f, 1e-6);
    EXPECT_NEAR(mapped.g, 0.26f, 1e-6);
    EXPECT_NEAR(mapped.b, 0.16f, 1e-6);
}

} // namespace
} // namespace framelet
