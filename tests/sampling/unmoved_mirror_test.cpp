// Tests the mirror of a viewer that leaves what it holds where it was rendered.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/framelet/sample_worth.h"
#include "tests/sampling/mirror_views.h"

namespace framelet {
namespace {

using namespace test;

constexpr bool moves_samples = false;
int const depth = plane.pixel_depth();

TEST(UnmovedMirror, ShowsWhatCameLastWhereItWasRendered) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions, moves_samples);
    mirror.add(view_at(Vec3(0)).rays, no_motions, render_pieces(plane, depth, wall, 0, 1));
    float const side = 8 * 10 * pixel_size(); // 8 pixels, of a wall 10 m away
    mirror.look(view_at(Vec3(side, 0, 0), 1), no_motions, moves_samples);
    for (Cell const& cell : cells_of(mirror)) {
        EXPECT_EQ(cell.covered, 0xffff) << "no holes: it moves nothing";
        EXPECT_NEAR(cell.worn, 1 + 8, 1.5f) << "but all is 8 pixels off";
    }
    mirror.add(view_at(Vec3(side, 0, 0)).rays, no_motions, render_pieces(plane, depth - 1, wall, 1, 2));
    for (Cell const& cell : cells_of(mirror)) {
        EXPECT_EQ(cell.worn, 2) << "coarser, and in its place";
        EXPECT_EQ(cell.stale, 0);
    }
    mirror.look(view_at(Vec3(side, 0, 0), 1), no_motions, moves_samples);
    for (Cell const& cell : cells_of(mirror)) {
        EXPECT_EQ(cell.worn, 2) << "what it took the place of is held no longer";
    }
}

/// A body of 32x32 pixels before the wall goes 32 pixels to the right.
TEST(UnmovedMirror, WhereABodyWasAndWhereItIsAreWrong) {
    constexpr BodyNumber body = 1;
    auto const look = [](float x, float y) {
        bool const in_body = x >= 32 && x < 64 && y >= 32 && y < 64;
        return in_body ? Seen{10, 0.5f + 0.3f * std::sin(2 * x), body} : Seen{};
    };
    BodyTrack track;
    track.body = body;
    track.keys.resize(2);
    track.keys[1].translation.x = 32 * 10 * pixel_size();
    BodyMotions motions;
    motions.extend(track);
    SceneTime const later = 1.0 / body_keys_per_second;
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), motions, moves_samples);
    mirror.add(view_at(Vec3(0)).rays, motions, render_pieces(plane, depth, look));
    mirror.look(view_at(Vec3(0), later), motions, moves_samples);
    EXPECT_NEAR(mirror.cell(12, 12).worn, 1 + 32, 5) << "it has gone";
    EXPECT_GT(mirror.cell(20, 12).stale, 0) << "it has come";
    EXPECT_EQ(mirror.cell(20, 12).worn, 1);
    EXPECT_EQ(mirror.cell(4, 4).worn, 1) << "nothing has happened";
    EXPECT_EQ(mirror.cell(4, 4).stale, 0);
}

/// Of every camera: parallel rays too, behind what was seen, turned, far away.
TEST(UnmovedMirror, EveryNumberIsFinite) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(-1, 1);
    auto const camera = [&] {
        Camera out;
        out.position = std::exp2(12 * number(random)) * Vec3(number(random), number(random), number(random));
        out.orientation = glm::normalize(Quat(1, number(random), number(random), number(random)));
        out.projection = random() % 2 == 0 ? Projection::orthographic : Projection::perspective;
        out.vertical_extent = out.projection == Projection::orthographic ? std::exp2(8 * number(random)) : 0.8f;
        return out;
    };
    Mirror mirror(viewport);
    for (std::uint64_t batch = 1; batch < 200; ++batch) {
        auto const look = [&](float x, float) { return Seen{x < 64 ? std::exp2(20 * number(random)) : INFINITY}; };
        mirror.look({make_view_rays(camera(), viewport), number(random)}, no_motions, moves_samples);
        mirror.add(make_view_rays(camera(), viewport), no_motions, render_pieces(plane, depth - 1, look, 0, batch));
        for (Cell const& cell : cells_of(mirror)) {
            ASSERT_TRUE(std::isfinite(cell.worn) && std::isfinite(cell.stale) && std::isfinite(cell.inverse_depth));
            ASSERT_LE(cell.worn, worn_step(worst_worn));
        }
    }
}

} // namespace
} // namespace framelet
