#include "server/render/light/brdf.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace framelet {
namespace {

/// Light reflected towards `view` under light from `to_light` of unit irradiance, normal +Z. `shared`: with what
/// comes back diffusely after several reflections between facets.
float reflected(Vec3 base, float metallic, float roughness, Vec3 view, Vec3 to_light, bool shared = true) {
    LaneVec3 b, n, v, l, e, sum;
    LaneFloats m, r;
    b.fill(base);
    n.fill({0, 0, 1});
    v.fill(view);
    l.fill(to_light);
    e.fill(Vec3(1));
    sum.fill(Vec3(0));
    m.fill(metallic);
    r.fill(roughness);
    LobePacket lobes;
    make_lobes(b, m, r, n, v, lobes);
    static SplitSumTable const split_sum;
    if (shared) {
        share_out(split_sum, r, all_lanes, lobes);
    }
    add_reflected(lobes, n, v, l, e, sum);
    return sum.y[0];
}

Vec3 at_angle(float theta, float phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

TEST(Brdf, TheLobeIsReciprocal) {
    Vec3 const a = at_angle(0.4f, 0.3f), b = at_angle(1.1f, 2.0f);
    EXPECT_NEAR(reflected(Vec3(0.8f), 1, 0.5f, a, b, false), reflected(Vec3(0.8f), 1, 0.5f, b, a, false), 1e-5f);
}

TEST(Brdf, MatchesTheFormulasByHand) {
    // Head on: h = n = v = l. D = 1/(pi a^2), V = 1/4, F = f0: 0.04 / (4 pi a^2); diffuse base / pi of the rest.
    float const a2 = 0.5f * 0.5f * 0.5f * 0.5f;
    float const pi = std::numbers::pi_v<float>;
    float const lobe = 0.04f / (4 * pi * a2);
    EXPECT_NEAR(reflected(Vec3(0.6f), 0, 0.5f, {0, 0, 1}, {0, 0, 1}, false), lobe + 0.6f / pi, 1e-5f);
    EXPECT_NEAR(reflected(Vec3(0.6f), 0, 0.5f, {0, 0, 1}, {0, 0, 1}), lobe + 0.96f * 0.6f / pi, 2e-3f);
}

TEST(Brdf, AWhiteMetalReflectsAllThatArrives) {
    for (float roughness : {0.2f, 0.4f, 0.7f, 1.0f}) {
        for (float view : {0.0f, 0.7f, 1.3f}) {
            double sum = 0;
            constexpr int steps = 500;
            for (int i = 0; i < steps; ++i) {
                for (int j = 0; j < steps; ++j) {
                    float const theta = (static_cast<float>(i) + 0.5f) / steps * 1.5707963f;
                    float const phi = (static_cast<float>(j) + 0.5f) / steps * 6.2831853f;
                    double const solid_angle = std::sin(theta) * 1.5707963 / steps * 6.2831853 / steps;
                    sum += reflected(Vec3(1), 1, roughness, at_angle(view, 0), at_angle(theta, phi)) * std::cos(theta) *
                           solid_angle;
                }
            }
            EXPECT_LT(sum, 1.02) << roughness << ' ' << view;
            EXPECT_GT(sum, 0.97) << roughness << ' ' << view << ": a white metal is white";
        }
    }
}

} // namespace
} // namespace framelet
