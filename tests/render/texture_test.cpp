#include "server/render/surface/texture.h"

#include <gtest/gtest.h>

#include "common/color.h"

namespace framelet {
namespace {

std::shared_ptr<Picture const> picture(int width, int height, std::vector<int> const& grey) {
    auto p = std::make_shared<Picture>(width, height);
    for (std::size_t i = 0; i < grey.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            p->rgba[i * 4 + c] = static_cast<std::uint8_t>(grey[i]);
        }
        p->rgba[i * 4 + 3] = 255;
    }
    return p;
}

float value_at(MipChain const& chain, Texture const& texture, Vec2 uv, TextureUse const& use = {}) {
    return TextureSampler(chain, texture, use).sample(uv, {}).r * 255;
}

TEST(Texture, UpperLeftTexelIsAtTheOriginOfUv) {
    MipChain const chain(picture(2, 2, {10, 20, 30, 40}), TexelKind::linear);
    Texture const texture;
    EXPECT_NEAR(value_at(chain, texture, {0.25f, 0.25f}), 10, 0.01);
    EXPECT_NEAR(value_at(chain, texture, {0.75f, 0.25f}), 20, 0.01);
    EXPECT_NEAR(value_at(chain, texture, {0.25f, 0.75f}), 30, 0.01);
    EXPECT_NEAR(value_at(chain, texture, {0.75f, 0.75f}), 40, 0.01);
    EXPECT_NEAR(value_at(chain, texture, {0.5f, 0.5f}), 25, 0.01);
}

TEST(Texture, WrapModes) {
    MipChain const chain(picture(4, 1, {0, 60, 120, 180}), TexelKind::linear);
    Texture repeat, clamp, mirror;
    clamp.wrap_u = Wrap::clamp;
    mirror.wrap_u = Wrap::mirror;
    EXPECT_NEAR(value_at(chain, repeat, {1.375f, 0}), 60, 0.01);
    EXPECT_NEAR(value_at(chain, repeat, {-0.625f, 0}), 60, 0.01);
    EXPECT_NEAR(value_at(chain, repeat, {0, 0}), 90, 0.01); // halfway between the last and the first
    EXPECT_NEAR(value_at(chain, clamp, {1.375f, 0}), 180, 0.01);
    EXPECT_NEAR(value_at(chain, clamp, {-3, 0}), 0, 0.01);
    EXPECT_NEAR(value_at(chain, mirror, {1.125f, 0}), 180, 0.01);
    EXPECT_NEAR(value_at(chain, mirror, {1.375f, 0}), 120, 0.01);
    EXPECT_NEAR(value_at(chain, mirror, {-0.375f, 0}), 60, 0.01);
    EXPECT_NEAR(value_at(chain, mirror, {2.125f, 0}), 0, 0.01);
}

TEST(Texture, NearestTakesOneTexel) {
    MipChain const chain(picture(2, 1, {0, 200}), TexelKind::linear);
    Texture texture;
    texture.nearest = true;
    EXPECT_NEAR(value_at(chain, texture, {0.45f, 0.5f}), 0, 0.01);
    EXPECT_NEAR(value_at(chain, texture, {0.55f, 0.5f}), 200, 0.01);
}

TEST(Texture, TransformScalesRotatesThenMoves) {
    MipChain const chain(picture(4, 4, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}), TexelKind::linear);
    TextureUse use;
    use.scale = {0.5f, 1};
    use.offset = {0.5f, 0.25f};
    EXPECT_NEAR(value_at(chain, {}, {0.25f, 0.125f}, use), 6, 0.01); // (0.625, 0.375)
    TextureUse turned;
    turned.rotation = 1.57079633f;
    // A quarter turn counter-clockwise with v down: (u, v) -> (v, -u).
    EXPECT_NEAR(value_at(chain, {}, {0.125f, 0.375f}, turned), 13, 0.01); // (0.375, -0.125 = 0.875)
}

TEST(Texture, CheckerboardFarAwayIsTheMeanOfItsLight) {
    std::vector<int> checks;
    for (int i = 0; i < 64 * 64; ++i) {
        checks.push_back((i % 64 + i / 64) % 2 ? 255 : 0);
    }
    MipChain const chain(picture(64, 64, checks), TexelKind::color);
    TextureSampler const sampler(chain, {}, {});
    for (float footprint : {0.1f, 0.5f, 1.0f, 40.0f}) {
        EXPECT_NEAR(sampler.sample({0.3f, 0.7f}, {{footprint, 0}, {0, footprint}}).r, 0.5f, 0.01f) << footprint;
    }
}

TEST(Texture, ElongatedFootprintBlursAlongItsAxisOnly) {
    std::vector<int> rows; // stripes one texel high: they run along u
    for (int i = 0; i < 64 * 64; ++i) {
        rows.push_back(i / 64 % 2 ? 255 : 0);
    }
    MipChain const chain(picture(64, 64, rows), TexelKind::linear);
    TextureSampler const sampler(chain, {}, {});
    Vec2 const at(0.5f, 32.5f / 64);
    EXPECT_NEAR(sampler.sample(at, {{4.0f / 64, 0}, {0, 1.0f / 64}}).r, 0, 0.01);
    EXPECT_NEAR(sampler.sample(at, {{0, 4.0f / 64}, {1.0f / 64, 0}}).r, 0.5, 0.05);
}

TEST(Texture, AlphaWeighsColourWhereSurfacesArePartlyThere) {
    auto p = std::make_shared<Picture>(2, 1);
    p->rgba = {255, 0, 0, 255, 0, 255, 0, 0}; // red leaf on green that is not there
    MipChain const cut_out(p, TexelKind::color_alpha);
    MipChain const opaque(p, TexelKind::color);
    EXPECT_EQ(cut_out.level(1).rgba[0], 255);
    EXPECT_EQ(cut_out.level(1).rgba[1], 0);
    EXPECT_EQ(cut_out.level(1).rgba[3], 128);
    EXPECT_EQ(opaque.level(1).rgba[0], srgb_byte_from_linear(0.5f));
}

TEST(Texture, WildCoordinatesStayFinite) {
    MipChain const chain(picture(4, 4, std::vector<int>(16, 128)), TexelKind::linear);
    TextureSampler const sampler(chain, {}, {});
    for (float wild : {1e30f, -1e30f, INFINITY, NAN}) {
        for (Vec2 const size : {Vec2(0), Vec2(1e4f), Vec2(INFINITY), Vec2(NAN)}) {
            EXPECT_NEAR(sampler.sample({wild, 0.5f}, {size, size}).r, 128.0f / 255, 1e-4f);
        }
        EXPECT_EQ(sampler.alpha({wild, 0}), 1);
    }
}

} // namespace
} // namespace framelet
