#include "server/sampling/mirror/piece.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/sampling/rendered_planes.h"

namespace framelet {
namespace {

ImagePlane const plane{Viewport{128, 128}};

std::vector<Piece> cut(Tile tile, Look const& look) {
    RenderedTile const one = render_tile(plane, tile, look);
    std::vector<Piece> pieces;
    cut_pieces(one, plane, 0, pieces);
    return pieces;
}

float area_of(Piece const& piece) {
    return 4 * piece.half_side.x * piece.half_side.y;
}

TEST(Piece, CoversItsTile) {
    for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
        Tile const tile = make_tile(depth, 0, 0);
        auto const side = static_cast<float>(plane.tile_side(tile));
        float area = 0;
        for (Piece const& piece : cut(tile, [](float, float) { return Seen{}; })) {
            area += area_of(piece);
            EXPECT_NEAR(piece.inverse_depth, 0.1f, 1e-6f);
            EXPECT_FLOAT_EQ(piece.spacing, plane.sample_spacing(tile));
            EXPECT_LE(2 * piece.half_side.x, 16);
            EXPECT_GE(2 * piece.half_side.x, 4);
        }
        EXPECT_FLOAT_EQ(area, side * side);
    }
}

TEST(Piece, NearAndFarAreApart) {
    auto const pieces = cut(make_tile(3, 0, 0), [](float x, float) { return x < 3 ? Seen{2, 0.2f} : Seen{20, 0.8f}; });
    float near_area = 0, far_area = 0;
    for (Piece const& piece : pieces) {
        bool const near = piece.inverse_depth > 0.1f;
        EXPECT_NEAR(piece.inverse_depth, near ? 0.5f : 0.05f, 1e-6f);
        EXPECT_NEAR(piece.luma, near ? 0.2f : 0.8f, 3e-3f);
        (near ? near_area : far_area) += area_of(piece);
    }
    EXPECT_FLOAT_EQ(near_area, 3 * 16);
    EXPECT_FLOAT_EQ(far_area, 13 * 16);
}

TEST(Piece, BodiesAreApart) {
    auto const pieces = cut(make_tile(3, 0, 0), [](float, float y) {
        return Seen{10, 0.5f, y < 4 ? BodyNumber{3} : static_body};
    });
    float area = 0;
    for (Piece const& piece : pieces) {
        area += piece.body == 3 ? area_of(piece) : 0;
    }
    EXPECT_FLOAT_EQ(area, 4 * 16);
}

TEST(Piece, KnowsTheSlopeOfWhatItShows) {
    for (Piece const &piece : cut(make_tile(3, 1, 1), [](float x, float y) {
             return Seen{10, 0.01f * x + 0.005f * y};
         })) {
        EXPECT_NEAR(piece.slope.x, 0.01f, 1e-3f);
        EXPECT_NEAR(piece.slope.y, 0.005f, 1e-3f);
    }
}

TEST(Piece, AnEdgeIsDetailBetweenAnyTwoSamples) {
    Tile const tile = make_tile(plane.pixel_depth(), 1, 1);
    PixelRect const rect = plane.tile_rect(tile);
    auto const detail_at = [&](int samples) {
        auto const edge = static_cast<float>(rect.left + samples);
        std::vector<Piece> pieces;
        cut_pieces(render_tile(plane, tile,
                               [&](float x, float) {
                                   return Seen{10, x < edge ? 0.3f : 0.7f};
                               }),
                   plane, 0, pieces);
        float detail = 0;
        for (Piece const& piece : pieces) {
            detail += piece.detail / static_cast<float>(pieces.size());
        }
        return detail;
    };
    for (int samples = 1; samples < framelet_side; ++samples) {
        EXPECT_NEAR(detail_at(samples) / detail_at(5), 1, 0.4) << samples;
    }
}

TEST(Piece, HostileDepthsGiveFiniteNumbers) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    for (float const depth : {0.0f, -0.0f, -1.0f, INFINITY, -INFINITY, nan, 1e-45f, 3e38f}) {
        for (bool const mixed : {false, true}) {
            auto const look = [&](float x, float y) {
                return Seen{mixed && static_cast<int>(x + y) % 3 == 0 ? 5.0f : depth, 0.5f};
            };
            for (Piece const& piece : cut(make_tile(3, 1, 1), look)) {
                for (float const value : {piece.centre.x, piece.half_side.x, piece.half_side.y, piece.inverse_depth,
                                          piece.luma, piece.slope.x, piece.slope.y, piece.detail}) {
                    EXPECT_TRUE(std::isfinite(value)) << depth;
                }
                EXPECT_GE(piece.inverse_depth, 0);
            }
        }
    }
}

} // namespace
} // namespace framelet
