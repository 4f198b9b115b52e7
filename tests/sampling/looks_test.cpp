#include "server/sampling/plan/looks.h"

#include <gtest/gtest.h>

#include "common/sample_worth.h"
#include "tests/sampling/rendered_planes.h"

namespace framelet {
namespace {

constexpr Viewport viewport{128, 96};
ImagePlane const plane{viewport};
BodyMotions const no_motions;

/// The camera goes by a wall at 10 metres, 3 pixels each moment; what is seen at a pixel of the first moment's picture.
struct GoingBy {
    static constexpr double seconds = 0.1;

    MirrorView view() const {
        Camera camera;
        float const metres = 10 * make_view_rays(camera, viewport).direction_dx.x;
        camera.position.x = 3 * static_cast<float>(moment) * metres;
        return {make_view_rays(camera, viewport), seconds * moment};
    }

    template <class Luma>
    void step(Luma&& luma) {
        mirror.look(view(), no_motions);
        std::vector<Piece> all;
        for (std::uint32_t row = 0; row < 8; ++row) {
            for (std::uint32_t column = 0; column < 8; ++column) {
                Tile const tile = make_tile(plane.pixel_depth(), column, row);
                if (!plane.is_visible(tile)) {
                    continue;
                }
                RenderedTile const one = render_tile(plane, tile, [&](float x, float y) {
                    return Seen{10, luma(x + 3 * static_cast<float>(moment), y, seconds * moment)};
                });
                std::vector<Piece> pieces;
                cut_pieces(one, plane, seconds * moment, pieces);
                codes[row][column] =
                    learn_fading(mirror, pieces, seconds * moment, mirror.looks_at(view()) && moment > 0, has_outlines);
                all.insert(all.end(), pieces.begin(), pieces.end());
            }
        }
        mirror.add(view().rays, no_motions, all);
        ++moment;
    }

    int moment = 0;
    bool has_outlines = false;
    Mirror mirror{viewport};
    FadingCode codes[8][8] = {};
};

float texture(float x, float y) {
    return 0.5f + 0.1f * std::sin(0.3f * x) * std::sin(0.4f * y) + 0.03f * std::sin(1.5f * x + y);
}

TEST(Looks, WhatOnlyTheCameraMovesPastDoesNotFade) {
    GoingBy wall;
    for (int i = 0; i < 8; ++i) {
        wall.step([](float x, float y, double) { return texture(x, y); });
    }
    for (int row = 0; row < 6; ++row) {
        for (int column = 0; column < 7; ++column) {
            EXPECT_LT(fading_rate(wall.codes[row][column]), 0.2f) << column << ' ' << row;
        }
    }
}

TEST(Looks, OutlinesFadeBeforeACameraThatMoves) {
    GoingBy past, before;
    before.has_outlines = true;
    for (int i = 0; i < 4; ++i) {
        for (GoingBy* const wall : {&past, &before}) {
            wall->step([](float x, float y, double) { return texture(x, y); });
        }
    }
    EXPECT_GT(fading_rate(before.codes[2][3]), 5 * fading_rate(past.codes[2][3]));
    before.mirror.look({before.view().rays, 1}, no_motions);
    std::vector<Piece> pieces(1);
    pieces[0].half_side = Vec2(8);
    pieces[0].detail = 0.01f;
    EXPECT_GT(learn_fading(before.mirror, pieces, 1, false, true), 0);
    EXPECT_EQ(learn_fading(before.mirror, pieces, 1, false, true, false), 0) << "nothing is expected";
    pieces[0].body = 3; // turns in the light, outlines or not
    EXPECT_GT(learn_fading(before.mirror, pieces, 1, false, false), 0);
    pieces[0].rests = true;
    EXPECT_EQ(learn_fading(before.mirror, pieces, 1, false, false), 0);
}

TEST(Looks, AShadowFadesWhatItPasses) {
    GoingBy wall;
    for (int i = 0; i < 8; ++i) {
        wall.step([](float x, float y, double time) {
            bool const dark = y < 40 && x < 20 + 60 * time; // its edge goes 6 pixels each moment
            return texture(x, y) * (dark ? 0.5f : 1.0f);
        });
    }
    // In the last moment its edge is 41 pixels from the left.
    EXPECT_GT(fading_rate(wall.codes[1][2]), 2);
    EXPECT_LT(fading_rate(wall.codes[5][5]), 1.5f);
    EXPECT_GT(fading_rate(wall.codes[1][2]), 10 * fading_rate(wall.codes[5][5]));
}

TEST(Looks, HostileNumbersGiveCodes) {
    GoingBy wall;
    for (float const luma : {0.0f, 1.0f, 0.0f}) {
        wall.step([luma](float, float, double) { return luma; });
        for (auto const& row : wall.codes) {
            for (FadingCode const code : row) {
                EXPECT_TRUE(std::isfinite(fading_rate(code)));
            }
        }
    }
}

} // namespace
} // namespace framelet
