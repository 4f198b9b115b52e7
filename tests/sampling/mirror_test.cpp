#include "server/sampling/mirror/mirror.h"

#include <array>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "common/framelet/sample_worth.h"
#include "tests/sampling/mirror_views.h"

namespace framelet {
namespace {

using namespace test;

TEST(Mirror, AStillPictureShowsWhatItWasSent) {
    for (int level = 0; level <= coarsest_levels + finest_levels; ++level) {
        int const depth = plane.pixel_depth() - coarsest_levels + level;
        Mirror mirror(viewport);
        mirror.look(view_at(Vec3(0)), no_motions);
        EXPECT_EQ(summary_of(mirror).holes, 1);
        mirror.add(view_at(Vec3(0)).rays, no_motions, render_pieces(plane, depth, wall));
        for (int again = 0; again < 6; ++again) { // nothing of it is forgotten
            Summary const summary = summary_of(mirror);
            EXPECT_EQ(summary.holes, 0);
            EXPECT_FLOAT_EQ(static_cast<float>(summary.worn),
                            std::max(plane.sample_spacing(make_tile(depth, 0, 0)), finest_shown_spacing));
            mirror.look(view_at(Vec3(0)), no_motions);
        }
    }
}

TEST(Mirror, WhatStandsHasNoHolesBetweenItsLayers) {
    Look const edge = [](float x, float y) { return Seen{0.31f * x + y < 70 ? 5.0f : 10.0f}; };
    for (int level = 0; level <= coarsest_levels + finest_levels; ++level) {
        Mirror mirror(viewport);
        mirror.look(view_at(Vec3(0)), no_motions);
        mirror.add(view_at(Vec3(0)).rays, no_motions,
                   render_pieces(plane, plane.pixel_depth() - coarsest_levels + level, edge));
        EXPECT_EQ(summary_of(mirror).holes, 0);
        mirror.look(view_at(Vec3(0), 1), no_motions);
        EXPECT_EQ(summary_of(mirror).holes, 0);
    }
}

/// Adds a shadow that was seen to go over all of the wall at second 1; the mirror then looks at second 1.1.
void add_shadow(Mirror& mirror, int depth) {
    std::vector<Piece> shadow = render_pieces(plane, depth, wall, 1, 2);
    for (Piece& piece : shadow) {
        piece.drift.velocity = Vec3(0.01f, 0, 0);
        piece.moves = true;
    }
    mirror.look(view_at(Vec3(0), 1), no_motions);
    mirror.add(view_at(Vec3(0)).rays, no_motions, shadow);
    mirror.look(view_at(Vec3(0), 1.1), no_motions);
}

TEST(Mirror, AShadowShowsForAWhileBeforeWhatItComesOver) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    mirror.add(view_at(Vec3(0)).rays, no_motions, render_pieces(plane, plane.pixel_depth(), wall));
    add_shadow(mirror, plane.pixel_depth() - 1);
    EXPECT_NEAR(summary_of(mirror).worn, 2, 1e-3);
    mirror.look(view_at(Vec3(0), 1.3), no_motions); // it may have gone elsewhere by now
    EXPECT_NEAR(summary_of(mirror).worn, 1, 1e-3);
}

TEST(Mirror, AnOldShadowDoesNotShowBeforeWhatIsCoarser) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    mirror.add(view_at(Vec3(0)).rays, no_motions, render_pieces(plane, plane.pixel_depth() - 1, wall));
    add_shadow(mirror, plane.pixel_depth());
    EXPECT_NEAR(summary_of(mirror).worn, 1, 1e-3);
    mirror.look(view_at(Vec3(0), 1.3), no_motions);
    EXPECT_NEAR(summary_of(mirror).worn, 2, 1e-3);
}

TEST(Mirror, WhatDriftsBrieflyIsReplacedInItsPlace) {
    for (bool const is_brief : {false, true}) {
        Mirror mirror(viewport);
        for (int coarser : {0, 1}) {
            double const time = 1 + 0.1 * coarser;
            std::vector<Piece> pieces = render_pieces(plane, plane.pixel_depth() - coarser, wall, time, coarser + 1U);
            for (Piece& piece : pieces) {
                piece.drift.velocity = Vec3(0.01f, 0, 0);
                piece.moves = true;
                piece.is_brief = is_brief;
            }
            mirror.look(view_at(Vec3(0), time), no_motions);
            mirror.add(view_at(Vec3(0)).rays, no_motions, pieces);
        }
        mirror.look(view_at(Vec3(0), 1.1), no_motions);
        EXPECT_NEAR(summary_of(mirror).worn, is_brief ? 2 : 1, 0.1) << "what is coarser hides nothing finer";
    }
}

/// Pieces of a wall that drifts to the right, nobody knows how far, as something that bends does.
std::vector<Piece> bending_wall(int depth, SceneTime time, std::uint64_t batch, float nearer) {
    std::vector<Piece> pieces = render_pieces(plane, depth, wall, time, batch);
    for (Piece& piece : pieces) {
        piece.inverse_depth *= nearer;
        piece.body = 7;
        piece.drift = {Vec3(40, 0, 0), Vec3(0), 1e4f};
        piece.moves = true;
    }
    return pieces;
}

TEST(Mirror, WhatIsLostShowsWhereItWasRenderedAndHidesNothing) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0), 1), no_motions);
    mirror.add(view_at(Vec3(0)).rays, no_motions, bending_wall(plane.pixel_depth(), 1, 1, 2));
    mirror.look(view_at(Vec3(0), 1.01), no_motions);
    EXPECT_GT(summary_of(mirror).holes, 0) << "it drifts away from the edge";
    mirror.look(view_at(Vec3(0), 2), no_motions);
    EXPECT_EQ(summary_of(mirror).holes, 0);
    EXPECT_GT(mirror.cell(3, 3).stale, 0.01f) << "it is to be rendered again";
    mirror.add(view_at(Vec3(0)).rays, no_motions, bending_wall(plane.pixel_depth() - 1, 2, 2, 1));
    mirror.look(view_at(Vec3(0), 2), no_motions);
    EXPECT_NEAR(summary_of(mirror).worn, 2, 0.1) << "what is lost is nearer and finer";
}

TEST(Mirror, LostOutliersOfAnotherMomentDoNotShowAndAreMissed) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0), 1), no_motions);
    std::vector<Piece> pieces = bending_wall(plane.pixel_depth(), 1, 1, 2);
    for (Piece& piece : pieces) {
        piece.is_outlier = true;
    }
    mirror.add(view_at(Vec3(0)).rays, no_motions, pieces);
    mirror.look(view_at(Vec3(0), 2), no_motions);
    EXPECT_EQ(summary_of(mirror).holes, 0) << "of the base they do";
    Vec3 const aside(pixel_size(), 0, 0);
    mirror.look(view_at(aside, 2), no_motions);
    mirror.add(view_at(aside, 2).rays, no_motions,
               render_pieces(plane, plane.pixel_depth() - 2, wall, 2, 2)); // coarser
    EXPECT_NEAR(summary_of(mirror).worn, 4, 0.2);
    mirror.look(view_at(aside, 2.01), no_motions);
    EXPECT_NEAR(summary_of(mirror).worn, 4, 0.2);
    EXPECT_GT(mirror.cell(3, 3).stale, 0.01f);
}

TEST(Mirror, AShadowShowsOnlyOnWhatIsAsFar) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    mirror.add(view_at(Vec3(0)).rays, no_motions,
               render_pieces(plane, plane.pixel_depth(), [](float, float) { return Seen{20.0f}; }));
    add_shadow(mirror, plane.pixel_depth() - 1); // half as far
    EXPECT_NEAR(summary_of(mirror).worn, 1, 1e-3);
}

TEST(Mirror, ACameraThatGoesSidewaysUncoversItsEdge) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    mirror.add(view_at(Vec3(0)).rays, no_motions, render_pieces(plane, plane.pixel_depth(), wall));
    mirror.look(view_at(Vec3(32 * 10 * pixel_size(), 0, 0)), no_motions); // 32 pixels at 10 metres
    Summary const summary = summary_of(mirror);
    EXPECT_NEAR(summary.holes, 32.0 / viewport.width, 0.02);
    EXPECT_NEAR(summary.worn, 1, 1e-3);
}

TEST(Mirror, WhatComesNearerGetsCoarser) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    mirror.add(view_at(Vec3(0)).rays, no_motions, render_pieces(plane, plane.pixel_depth(), wall));
    mirror.look(view_at(Vec3(0, 0, -5)), no_motions); // from 10 metres to 5
    Summary const summary = summary_of(mirror);
    EXPECT_EQ(summary.holes, 0);
    EXPECT_NEAR(summary.worn, 2, 1e-3);
    mirror.look(view_at(Vec3(0, 0, 10)), no_motions); // and back to 20
    EXPECT_NEAR(summary_of(mirror).holes, 0.75, 0.03);
    EXPECT_NEAR(summary_of(mirror).worn, finest_shown_spacing, 1e-3);
}

TEST(Mirror, WhatMayBeFarOffItsPlaceIsAHole) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    std::vector<Piece> pieces = render_pieces(plane, plane.pixel_depth(), wall);
    for (Piece& piece : pieces) {
        piece.error = 0.5f * piece.inverse_depth;
    }
    mirror.add(view_at(Vec3(0)).rays, no_motions, pieces);
    mirror.look(view_at(Vec3(8 * 10 * pixel_size(), 0, 0)), no_motions); // by 8 pixels, give or take 4
    EXPECT_NEAR(summary_of(mirror).holes, 8.0 / viewport.width, 0.02);
    mirror.look(view_at(Vec3(32 * 10 * pixel_size(), 0, 0)), no_motions);
    EXPECT_EQ(summary_of(mirror).holes, 1);
}

TEST(Mirror, WhatIsUncoveredWasHeldOnceOrIsAHole) {
    // A near square before a wall, and the camera goes by it.
    auto const look_from = [](float shift) {
        return [shift](float x, float y) {
            float const at = x + 4 * shift; // pixels at 2.5 metres move four times as far as at 10
            return at >= 60 && at < 92 && y >= 32 && y < 64 ? Seen{2.5f, 0.1f} : Seen{};
        };
    };
    auto const moved = [](float pixels) { return view_at(Vec3(pixels * 10 * pixel_size(), 0, 0)); };
    auto const uncovered = [&](Mirror const& mirror) {
        int holes = 0;
        for (int row = 8; row < 16; ++row) {
            for (int column = 8; column < 23; ++column) {
                holes += cell_side * cell_side - std::popcount(mirror.cell(column, row).covered);
            }
        }
        return holes;
    };
    Mirror mirror(viewport);
    mirror.look(moved(0), no_motions);
    mirror.add(moved(0).rays, no_motions, render_pieces(plane, plane.pixel_depth(), look_from(0)));
    mirror.look(moved(4), no_motions); // the square goes 16 pixels, the wall behind it 4
    EXPECT_NEAR(uncovered(mirror), 12 * 32, 100);
    mirror.add(moved(4).rays, no_motions, render_pieces(plane, plane.pixel_depth(), look_from(4)));
    mirror.look(moved(0), no_motions);
    EXPECT_EQ(uncovered(mirror), 0) << "each moment has seen what the other one has not";
    mirror.look(moved(2), no_motions);
    EXPECT_LT(uncovered(mirror), 40);
}

TEST(Mirror, TheLeastWornShows) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    auto fine = render_pieces(plane, plane.pixel_depth(), wall);
    for (Piece& piece : fine) {
        piece.decorrelation = 1;
    }
    mirror.add(view_at(Vec3(0), 0).rays, no_motions, fine);
    Vec3 const aside(1e-5f, 0, 0);
    mirror.look(view_at(aside, 2), no_motions);
    EXPECT_NEAR(summary_of(mirror).worn, worn_step(3), 1e-3) << "two seconds at a pixel a second";
    mirror.add(view_at(aside, 2).rays, no_motions, render_pieces(plane, plane.pixel_depth() - 2, wall, 2));
    EXPECT_NEAR(summary_of(mirror).worn, worn_step(3), 1e-3) << "fresh ones 4 pixels apart are no better";
    mirror.add(view_at(aside, 2).rays, no_motions, render_pieces(plane, plane.pixel_depth() - 1, wall, 2));
    EXPECT_NEAR(summary_of(mirror).worn, 2, 1e-3);
}

TEST(Mirror, OutliersWearByTheirSpacingOnceMoved) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    auto pieces = render_pieces(plane, plane.pixel_depth(), wall); // 10 m away
    for (Piece& piece : pieces) {
        piece.is_outlier = true;
    }
    mirror.add(view_at(Vec3(0)).rays, no_motions, pieces);
    mirror.look(view_at(Vec3(0, 0, -5)), no_motions);
    EXPECT_NEAR(summary_of(mirror).worn, 2, 1e-3);
    mirror.look(view_at(Vec3(0, 0, 5)), no_motions);
    EXPECT_NEAR(summary_of(mirror).worn, 1, 1e-3);
}

TEST(Mirror, WhatHasNotMovedDoesNotWear) {
    constexpr BodyNumber body = 1;
    BodyTrack track{body, 0, {}}; // stands for 3 s, then goes to the right at a metre a second
    for (int key = 0; key < 4 * body_keys_per_second; ++key) {
        track.keys.push_back(
            {Vec3(static_cast<float>(std::max(key - 3 * body_keys_per_second, 0)) / body_keys_per_second, 0, 0)});
    }
    BodyMotions motions;
    motions.extend(track);
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), motions);
    auto pieces = render_pieces(plane, plane.pixel_depth(), wall);
    for (Piece& piece : pieces) {
        piece.body = body;
        piece.decorrelation = 1;
    }
    mirror.add(view_at(Vec3(0), 0).rays, motions, pieces);
    mirror.look(view_at(Vec3(0), 2.9), motions);
    EXPECT_NEAR(summary_of(mirror).worn, 1, 1e-3);
    mirror.look(view_at(Vec3(0), 3.02), motions);
    EXPECT_NEAR(summary_of(mirror).worn, worn_step(4), 1e-3) << "then at once: it comes into other light";
}

/// What is planned now shows a moment later: until then a shadow has to last with the viewer.
TEST(Mirror, AShadowIsRenewedBeforeTheViewerGivesItUp) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    auto pieces = render_pieces(plane, plane.pixel_depth(), wall);
    for (Piece& piece : pieces) {
        piece.drift.velocity = Vec3(1e-3f, 0, 0);
    }
    mirror.add(view_at(Vec3(0), 0).rays, no_motions, pieces);
    mirror.look(view_at(Vec3(0), 0.1), no_motions);
    EXPECT_TRUE(mirror.cell(5, 5).is_shown() && mirror.cell(5, 5).leads);
    mirror.look(view_at(Vec3(0), 0.35), no_motions);
    EXPECT_FALSE(mirror.cell(5, 5).is_shown());
    EXPECT_TRUE(leads(static_body, pieces.front().drift, 0.35f)) << "the viewer shows it still";
}

TEST(Mirror, WhatIsOlderThanAJumpShowsBehindWhatIsNot) {
    for (bool const jumps : {false, true}) {
        BodyMotions motions;
        if (jumps) {
            motions.jump_at(1);
        }
        Mirror mirror(viewport);
        mirror.look(view_at(Vec3(0)), motions);
        mirror.add(view_at(Vec3(0), 0).rays, motions, render_pieces(plane, plane.pixel_depth(), wall));
        Vec3 const aside(1e-5f, 0, 0);
        mirror.look(view_at(aside, 0.9), motions);
        EXPECT_FALSE(mirror.gives_way(mirror.cell(3, 3)));
        mirror.look(view_at(aside, 1), motions);
        EXPECT_EQ(mirror.gives_way(mirror.cell(3, 3)), jumps);
        mirror.add(view_at(aside, 1).rays, motions, render_pieces(plane, plane.pixel_depth() - 2, wall, 1));
        EXPECT_NEAR(summary_of(mirror).worn, jumps ? 4 : 1, 1e-3);
    }
}

TEST(Mirror, OfOneCameraTheNewestIsHeld) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0), 0), no_motions);
    mirror.add(view_at(Vec3(0), 0).rays, no_motions, render_pieces(plane, plane.pixel_depth(), wall));
    mirror.look(view_at(Vec3(0), 1), no_motions);
    mirror.add(view_at(Vec3(0), 1).rays, no_motions, render_pieces(plane, plane.pixel_depth() - 1, wall, 1, 2));
    mirror.look(view_at(Vec3(0), 2), no_motions);
    EXPECT_NEAR(summary_of(mirror).worn, 2, 1e-3);
    EXPECT_EQ(summary_of(mirror).holes, 0);
    EXPECT_TRUE(mirror.gives_way(mirror.cell(3, 3)));
}

/// Whoever takes part in a look, and however what comes is divided.
TEST(Mirror, LooksTheSameOnAnyNumberOfThreads) {
    auto const cells_by = [](std::size_t threads) {
        tbb::global_control const limit(tbb::global_control::max_allowed_parallelism, threads);
        tbb::task_arena arena(static_cast<int>(threads));
        Mirror mirror(viewport);
        arena.execute([&] {
            for (int i = 0; i < 4; ++i) {
                auto const time = static_cast<double>(i);
                MirrorView const view = view_at(Vec3(0.1f * static_cast<float>(i), 0, 0), time);
                mirror.look(view, no_motions);
                std::vector<Piece> pieces =
                    render_pieces(plane, plane.pixel_depth() + 1 - i, wall, time, static_cast<std::uint64_t>(i + 1));
                for (std::size_t k = 0; k < pieces.size(); k += 3) {
                    pieces[k].drift.velocity = Vec3(0.3f, 0, 0);
                    pieces[k].moves = true;
                }
                std::vector<std::vector<Piece>> lists(threads);
                for (std::size_t k = 0; k < pieces.size(); ++k) {
                    lists[k * threads / pieces.size()].push_back(pieces[k]);
                }
                mirror.add(view.rays, no_motions, lists);
            }
            mirror.look(view_at(Vec3(0.35f, 0.05f, 0.1f), 3.2), no_motions);
        });
        std::vector<std::array<float, 5>> cells;
        for (int row = 0; row < mirror.rows(); ++row) {
            for (int column = 0; column < mirror.columns(); ++column) {
                Cell const& cell = mirror.cell(column, row);
                cells.push_back({cell.inverse_depth, cell.worn, static_cast<float>(cell.piece),
                                 static_cast<float>(cell.moment), static_cast<float>(cell.covered)});
            }
        }
        return cells;
    };
    auto const alone = cells_by(1);
    EXPECT_EQ(cells_by(3), alone);
    EXPECT_EQ(cells_by(8), alone);
}

TEST(Mirror, KeepsTheNewestMoments) {
    // Each moment has a camera of its own, hardly moved, and one tile.
    constexpr int moments = 100, columns = viewport.width / 16, tiles = columns * viewport.height / 16;
    constexpr int most = 2 * int{FrameletPool::most_moments};
    static_assert(most < tiles && tiles < moments);
    Mirror mirror(viewport);
    auto const view = [](int moment) { return view_at(Vec3(1e-5f * static_cast<float>(moment), 0, 0), moment); };
    auto const tile_of = [](int moment) {
        int const i = moment % tiles;
        return make_tile(plane.pixel_depth(), static_cast<std::uint32_t>(i % columns),
                         static_cast<std::uint32_t>(i / columns));
    };
    for (int i = 0; i < moments; ++i) {
        mirror.look(view(i), no_motions);
        std::vector<Piece> pieces;
        cut_pieces(render_tile(plane, tile_of(i), wall), plane, i, pieces, static_cast<std::uint64_t>(i + 1));
        mirror.add(view(i).rays, no_motions, pieces);
    }
    mirror.look(view(moments), no_motions);
    for (int age = 0; age < tiles; ++age) {
        PixelRect const rect = plane.tile_rect(tile_of(moments - 1 - age));
        EXPECT_EQ(mirror.cell((rect.left + 8) / cell_side, (rect.top + 8) / cell_side).is_shown(), age < most) << age;
    }
}

TEST(Mirror, ForgetsWhatTheViewerEvicted) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    Tile const tile = make_tile(plane.pixel_depth(), 2, 3);
    mirror.add(view_at(Vec3(0)).rays, no_motions, render_pieces(plane, plane.pixel_depth(), wall)); // batch 1
    std::vector<SentTile> const gone{{1, tile}, {2, make_tile(plane.pixel_depth(), 0, 0)}};
    mirror.forget(gone);
    mirror.look(view_at(Vec3(0)), no_motions);
    PixelRect const rect = plane.tile_rect(tile);
    EXPECT_NEAR(summary_of(mirror).holes * viewport.width * viewport.height, rect.width() * rect.height(), 80)
        << "a margin of half a pixel";
    EXPECT_FALSE(mirror.cell((rect.left + 8) / cell_side, (rect.top + 8) / cell_side).is_shown());
}

TEST(Mirror, HostileViewsAndDepthsDoNoHarm) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    Mirror mirror(viewport);
    for (float const depth : {0.0f, -1.0f, INFINITY, nan, 1e-30f, 1e30f}) {
        mirror.look(view_at(Vec3(0)), no_motions);
        mirror.add(view_at(Vec3(0)).rays, no_motions, render_pieces(plane, plane.pixel_depth(), [&](float, float) {
                       return Seen{depth, 0.5f};
                   }));
        for (float const far : {-1e10f, -1e-6f, 1e-6f, 1.0f, 1e10f}) {
            mirror.look(view_at(Vec3(far, far, far)), no_motions);
            for (Cell const& cell : cells_of(mirror)) {
                EXPECT_TRUE(std::isfinite(cell.inverse_depth) && std::isfinite(cell.worn) &&
                            std::isfinite(cell.detail));
            }
        }
    }
}

} // namespace
} // namespace framelet
