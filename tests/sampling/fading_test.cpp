#include "server/sampling/plan/moment/fading.h"

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

FadingCode code_of(Piece piece, bool camera_stands, bool has_outline) {
    FadingCode const code = expect_fading({&piece, 1}, camera_stands, has_outline);
    EXPECT_EQ(piece.fading, fading_rate(code));
    return code;
}

TEST(Fading, MotionAloneFadesNothing) {
    EXPECT_EQ(code_of(detailed_piece(), true, false), 0);
    EXPECT_EQ(code_of(detailed_piece(), false, false), 0);
}

TEST(Fading, OutlinesAndReflectionsFadeBeforeACameraThatMoves) {
    EXPECT_GT(code_of(detailed_piece(), false, true), 0);
    EXPECT_EQ(code_of(detailed_piece(), true, true), 0);
    Piece mirroring = detailed_piece();
    mirroring.reflects = true;
    EXPECT_GT(code_of(mirroring, false, false), 0);
    EXPECT_EQ(code_of(mirroring, true, false), 0);
}

TEST(Fading, WhatTurnsInTheLightFadesUnlessItRests) {
    Piece turning = detailed_piece();
    turning.body = 3;
    EXPECT_GT(code_of(turning, true, false), 0);
    turning.rests = true;
    EXPECT_EQ(code_of(turning, true, false), 0);
}

TEST(Fading, IsTheShareOfWhatChanges) {
    std::array<Piece, 2> pieces{detailed_piece(), detailed_piece()};
    pieces[0].reflects = true;
    EXPECT_EQ(expect_fading(pieces, false, false), fading_code(0.5f * fading_rate(code_of(pieces[0], false, false))));
    EXPECT_EQ(pieces[0].fading, pieces[1].fading);
}

TEST(Fading, HostileNumbersGiveRates) {
    float const worst = std::numeric_limits<float>::max();
    for (float const detail : {0.0f, 1e-38f, 1.0f, worst}) {
        for (float const side : {0.0f, 1e-20f, 8.0f, worst}) {
            Piece piece = detailed_piece();
            piece.detail = detail;
            piece.half_side = Vec2(side);
            EXPECT_TRUE(std::isfinite(fading_rate(expect_fading({&piece, 1}, false, true))));
            EXPECT_TRUE(std::isfinite(piece.fading));
        }
    }
}

} // namespace
} // namespace framelet
