#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/sampling/mirror_views.h"

namespace framelet {
namespace {

using namespace test;

TEST(Mirror, ABodyCarriesItsPieces) {
    BodyMotions motions;
    BodyTrack track;
    track.body = 1;
    track.first_key = 0;
    for (int key = 0; key <= body_keys_per_second; ++key) {
        BodyPose pose;
        pose.translation.x = static_cast<float>(key) / body_keys_per_second * 32 * 10 * pixel_size();
        track.keys.push_back(pose);
    }
    motions.extend(track);
    auto const half = [](float x, float) { return Seen{10, 0.5f, x < 64 ? BodyNumber{1} : static_body}; };
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), motions);
    mirror.add(view_at(Vec3(0)).rays, motions, render_pieces(plane, plane.pixel_depth(), half));
    mirror.look(view_at(Vec3(0), 1), motions); // 32 pixels to the right
    EXPECT_NEAR(summary_of(mirror).holes, 32.0 / viewport.width, 0.02);
    EXPECT_EQ(mirror.cell(2, 4).covered, 0);
}

/// A square of 32 pixels that goes 32 pixels a second to the right, 2.5 metres away, before a wall.
BodyMotions sliding() {
    BodyMotions motions;
    BodyTrack track{1, 0, {}};
    for (int key = 0; key <= 4 * body_keys_per_second; ++key) {
        BodyPose pose;
        pose.translation.x = static_cast<float>(key) / body_keys_per_second * 32 * 2.5f * pixel_size();
        track.keys.push_back(pose);
    }
    motions.extend(track);
    return motions;
}
Look slid(SceneTime time) {
    return [time](float x, float y) {
        float const at = x - 32 * static_cast<float>(time);
        return at >= 16 && at < 48 && y >= 32 && y < 64 ? Seen{2.5f, 0.1f, 1} : Seen{};
    };
}
/// Number of the 64 cells of the square at a time that show it.
int square_cells(Mirror const& mirror, SceneTime time) {
    int count = 0;
    for (int row = 8; row < 16; ++row) {
        for (int column = 4; column < 12; ++column) {
            Cell const& cell = mirror.cell(column + static_cast<int>(8 * time), row);
            count += cell.inverse_depth > 0.3f ? 1 : 0;
        }
    }
    return count;
}

TEST(Mirror, ABodyBeforeAStandingCameraIsHeldAndSoIsWhatItCovers) {
    BodyMotions const motions = sliding();
    Mirror mirror(viewport);
    auto const part = [&](SceneTime time, std::uint64_t batch, bool of_square) {
        std::vector<Piece> pieces = render_pieces(plane, plane.pixel_depth(), slid(time), time, batch);
        auto const is_left = [](Piece const& piece) { return piece.centre.x < 48; };
        if (of_square) {
            std::erase_if(pieces, [](Piece const& piece) { return !piece.moves; });
        } else {
            std::erase_if(pieces, [&](Piece const& piece) { return !is_left(piece); });
        }
        return pieces;
    };
    mirror.look(view_at(Vec3(0), 0), motions);
    mirror.add(view_at(Vec3(0)).rays, motions, render_pieces(plane, plane.pixel_depth(), wall, 0, 1));
    mirror.look(view_at(Vec3(0), 0.5), motions);
    mirror.add(view_at(Vec3(0)).rays, motions, part(0.5, 2, true));
    EXPECT_EQ(square_cells(mirror, 0.5), 64);
    EXPECT_FALSE(mirror.gives_way(mirror.cell(10, 10))) << "what comes need not move";
    EXPECT_TRUE(mirror.gives_way(mirror.cell(1, 1)));
    mirror.look(view_at(Vec3(0), 1.5), motions);
    EXPECT_EQ(square_cells(mirror, 1.5), 64);
    EXPECT_EQ(summary_of(mirror).holes, 0) << "the wall that it covered is held";
    mirror.add(view_at(Vec3(0)).rays, motions, part(1.5, 3, false)); // its old place, of which it has gone
    mirror.look(view_at(Vec3(0), 2), motions);
    EXPECT_EQ(square_cells(mirror, 2), 64);
    mirror.settle();
    mirror.look(view_at(Vec3(0), 2), motions);
    EXPECT_LT(square_cells(mirror, 2), 64) << "at one place the newest is held";
    EXPECT_TRUE(mirror.gives_way(mirror.cell(1, 1)));
}

TEST(Mirror, WhatRestsGivesWayAndLeavesAHoleWhenItSetsOut) {
    BodyMotions motions = sliding();
    BodyTrack track{1, 0, {}};
    for (int key = 0; key <= 4 * body_keys_per_second; ++key) {
        float const time = std::max(static_cast<float>(key) / body_keys_per_second - 2, 0.0f);
        track.keys.push_back({Vec3(time * 32 * 2.5f * pixel_size(), 0, 0), {1, 0, 0, 0}, Vec3(1)});
    }
    motions.extend(track);
    auto const resting = [&](SceneTime time, std::uint64_t batch) {
        std::vector<Piece> pieces = render_pieces(plane, plane.pixel_depth(), slid(0), time, batch);
        std::ranges::for_each(pieces, [](Piece& piece) { piece.rests = true; });
        return pieces;
    };
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0), 0), motions);
    mirror.add(view_at(Vec3(0)).rays, motions, resting(0, 1));
    mirror.look(view_at(Vec3(0), 1), motions);
    EXPECT_TRUE(mirror.gives_way(mirror.cell(10, 10)));
    EXPECT_EQ(summary_of(mirror).holes, 0);
    mirror.add(view_at(Vec3(0)).rays, motions, resting(1, 2));
    EXPECT_TRUE(mirror.gives_way(mirror.cell(10, 10)));
    mirror.look(view_at(Vec3(0), 1.5), motions);
    EXPECT_EQ(mirror.piece_of(mirror.cell(10, 10)).of.batch, 2U);
    EXPECT_EQ(square_cells(mirror, 0), 64);
    mirror.look(view_at(Vec3(0), 3), motions);
    EXPECT_EQ(square_cells(mirror, 1), 64);
    EXPECT_EQ(mirror.cell(6, 10).covered, 0) << "nothing is held of the wall that it stood before";
}

} // namespace
} // namespace framelet
