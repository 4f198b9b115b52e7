#include "common/color.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/error.h"
#include "common/tone_inverse.h"

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

constexpr ToneCurve all_curves[] = {ToneCurve::neutral, ToneCurve::aces, ToneCurve::agx, ToneCurve::linear};

TEST(Color, EveryCurveStaysInRangeAndGetsBrighterWithGreyThatStaysGrey) {
    for (ToneCurve const curve : all_curves) {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> exponent(-140, 127);
        for (int i = 0; i < 200000; ++i) {
            Vec3 const color(std::exp2(exponent(random)), std::exp2(exponent(random)), std::exp2(exponent(random)));
            Vec3 const mapped = tone_map(color, curve);
            for (int c = 0; c < 3; ++c) {
                ASSERT_TRUE(mapped[c] >= 0 && mapped[c] <= 1) << color.x << ' ' << color.y << ' ' << color.z;
            }
        }
        float previous = -1;
        for (float grey = 0; grey < 100; grey += 0.01f) {
            Vec3 const mapped = tone_map(Vec3(grey), curve);
            ASSERT_GE(mapped.g, previous - 1e-6f) << grey;
            ASSERT_NEAR(mapped.r, mapped.b, 3e-4f);
            previous = mapped.g;
        }
        EXPECT_NEAR(tone_map(Vec3(0), curve).g, 0, 1e-4);
        EXPECT_GT(previous, 0.98f);
    }
}

TEST(Color, WhatTheNeutralCurveShowsAsAColourIsFound) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> light(0, 1.5f);
    for (int i = 0; i < 200000; ++i) {
        Vec3 const color = tone_map(Vec3(light(random), light(random), light(random)));
        if (std::max({color.r, color.g, color.b}) <= 0.98f) {
            Vec3 const shown = tone_map(radiance_shown_as(color, ToneCurve::neutral));
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(srgb_byte_from_linear(shown[c]), srgb_byte_from_linear(color[c]), 1)
                    << color.r << ' ' << color.g << ' ' << color.b;
            }
        }
    }
    for (ToneCurve const curve : all_curves) {
        for (Vec3 const extreme : {Vec3(0), Vec3(1), Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(7, 0, 1e-20f)}) {
            Vec3 const radiance = radiance_shown_as(extreme, curve);
            for (int c = 0; c < 3; ++c) {
                ASSERT_TRUE(std::isfinite(radiance[c]) && radiance[c] >= 0);
            }
        }
    }
    EXPECT_GE(srgb_byte_from_linear(tone_map(radiance_shown_as(Vec3(1), ToneCurve::neutral)).g), 252);
    EXPECT_EQ(radiance_shown_as(Vec3(0), ToneCurve::neutral), Vec3(0));
}

TEST(Color, CurvesKnownValues) { // of their published formulas in double precision
    struct Known {
        ToneCurve curve;
        Vec3 in, out;
    };
    for (auto const& [curve, in, out] : {Known{ToneCurve::aces, Vec3(0.18f), Vec3(0.213105f)},
                                         {ToneCurve::aces, Vec3(1), Vec3(0.763397f)},
                                         {ToneCurve::aces, {1, 0.2f, 0.05f}, {0.871909f, 0.290495f, 0.071219f}},
                                         {ToneCurve::aces, {0, 0, 5}, {0.376761f, 0.035303f, 1}},
                                         {ToneCurve::agx, Vec3(0.18f), {0.214549f, 0.214502f, 0.214499f}},
                                         {ToneCurve::agx, Vec3(16), {0.995212f, 0.995099f, 0.995009f}},
                                         {ToneCurve::agx, {1, 0.2f, 0.05f}, {0.651827f, 0.262023f, 0.122971f}},
                                         {ToneCurve::linear, {0.3f, 1, 7}, {0.3f, 1, 1}}}) {
        Vec3 const mapped = DisplayTransform(0.5f, curve).shown(in * 2.0f);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(mapped[c], out[c], 2e-5) << static_cast<int>(curve) << ' ' << in.x;
        }
    }
}

TEST(Color, CurvesHaveNames) {
    EXPECT_EQ(parse_tone_curve("neutral"), ToneCurve::neutral);
    EXPECT_EQ(parse_tone_curve("aces"), ToneCurve::aces);
    EXPECT_EQ(parse_tone_curve("agx"), ToneCurve::agx);
    EXPECT_EQ(parse_tone_curve("linear"), ToneCurve::linear);
    EXPECT_THROW(parse_tone_curve("filmic"), InputError);
}

} // namespace
} // namespace framelet
