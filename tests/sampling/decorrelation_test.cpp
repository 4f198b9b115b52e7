#include "server/sampling/plan/moment/decorrelation.h"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace framelet {
namespace {

Piece detailed_piece() {
    Piece piece;
    piece.half_side = Vec2(8);
    piece.detail = 0.01f;
    return piece;
}

DecorrelationCode code_of(Piece piece, bool camera_stands, bool has_outline) {
    DecorrelationCode const code = expect_decorrelation({&piece, 1}, camera_stands, has_outline);
    EXPECT_EQ(piece.decorrelation, decorrelation_rate(code));
    return code;
}

TEST(Decorrelation, MotionAloneDecorrelatesNothing) {
    EXPECT_EQ(code_of(detailed_piece(), true, false), 0);
    EXPECT_EQ(code_of(detailed_piece(), false, false), 0);
}

TEST(Decorrelation, OutlinesAndReflectionsDecorrelateBeforeACameraThatMoves) {
    EXPECT_GT(code_of(detailed_piece(), false, true), 0);
    EXPECT_EQ(code_of(detailed_piece(), true, true), 0);
    Piece mirroring = detailed_piece();
    mirroring.reflects = true;
    EXPECT_GT(code_of(mirroring, false, false), 0);
    EXPECT_EQ(code_of(mirroring, true, false), 0);
}

/// Old samples of a surface must not outlast new ones because there is more detail beside them.
TEST(Decorrelation, WhatIsCarriedWearsAtMuchTheSameRateWhateverItsDetail) {
    for (float const detail : {1e-6f, 1e-4f, 0.01f, 0.1f}) {
        for (bool const rests : {false, true}) {
            Piece carried = detailed_piece();
            carried.body = 3;
            carried.rests = rests;
            carried.detail = detail;
            float const rate = decorrelation_rate(code_of(carried, true, false));
            EXPECT_GE(rate, 0.95f);
            EXPECT_LE(rate, 3.15f);
        }
    }
}

TEST(Decorrelation, IsTheShareOfWhatChanges) {
    std::array<Piece, 2> pieces{detailed_piece(), detailed_piece()};
    pieces[0].reflects = true;
    EXPECT_EQ(expect_decorrelation(pieces, false, false),
              decorrelation_code(0.5f * decorrelation_rate(code_of(pieces[0], false, false))));
    EXPECT_EQ(pieces[0].decorrelation, pieces[1].decorrelation);
}

TEST(Decorrelation, HostileNumbersGiveRates) {
    float const worst = std::numeric_limits<float>::max();
    for (float const detail : {0.0f, 1e-38f, 1.0f, worst}) {
        for (float const side : {0.0f, 1e-20f, 8.0f, worst}) {
            Piece piece = detailed_piece();
            piece.detail = detail;
            piece.half_side = Vec2(side);
            EXPECT_TRUE(std::isfinite(decorrelation_rate(expect_decorrelation({&piece, 1}, false, true))));
            EXPECT_TRUE(std::isfinite(piece.decorrelation));
        }
    }
}

} // namespace
} // namespace framelet
