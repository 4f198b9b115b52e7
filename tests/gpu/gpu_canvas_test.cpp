// Compares what the graphics card paints with what the processor paints of the same, on whatever OpenGL there is: in
// tests Mesa's on the processor.
#include "client/gpu/gpu_canvas.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "tests/gpu/gl_context.h"
#include "tests/gpu/scene_session.h"

namespace framelet {
namespace {

constexpr Viewport size{336, 200}; // of whole blocks in neither direction

/// Most pixels, counted in both pictures of 67200, that may have strayed: single ones of what is thin, no outline.
constexpr int most_strayed = 12;

/// Mean differences over all channels of all pixels, channels in [0, 1].
struct Difference {
    double absolute = 0, squared = 0;
};

Difference difference(Picture const& a, Picture const& b) {
    Difference out;
    double values = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        if (i % 4 != 3) {
            double const d = (a.rgba[i] - b.rgba[i]) / 255.0;
            out.absolute += std::abs(d);
            out.squared += d * d;
            ++values;
        }
    }
    return {out.absolute / values, out.squared / values};
}

/// True where both inverse depths are of holes, or of one surface.
bool is_same_surface(float a, float b) {
    return a == b || (std::min(a, b) >= 0 && std::abs(a - b) <= 0.02f * std::max(a, b) + 1e-6f);
}

/// Number of pixels that show another surface than the other picture does there or at any pixel beside it: there an
/// outline is more than a pixel away.
int strayed_pixels(std::span<float const> depths, std::span<float const> other) {
    int out = 0;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            bool is_near = false;
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, size.height - 1); ++j) {
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, size.width - 1); ++i) {
                    is_near = is_near || is_same_surface(depths[static_cast<std::size_t>(y * size.width + x)],
                                                         other[static_cast<std::size_t>(j * size.width + i)]);
                }
            }
            out += is_near ? 0 : 1;
        }
    }
    return out;
}

std::vector<Tile> shown_of(Reprojector const& reprojector, std::size_t slot) {
    std::vector<Tile> tiles;
    reprojector.add_shown(slot, tiles);
    std::ranges::sort(tiles, {}, &Tile::code);
    tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
    return tiles;
}

/// A session whose pictures are painted by both, the processor and the card.
struct Both {
    SceneSession session;
    Holder held{size};
    Reprojector processor, card;
    Picture expected{size.width, size.height}, unused{size.width, size.height}, painted;
    std::vector<PixelRect> changed, repainted;

    explicit Both(std::string const& scene) : session(scene, size) {}

    void show(double now, Camera const& camera, bool plays, GpuCanvas& canvas) {
        session.advance(now, camera, plays, [&](Batch const& batch) {
            return held.insert(
                batch, [&](std::size_t slot, std::vector<Tile>& tiles) { return processor.add_shown(slot, tiles); });
        });
        held.pool.newest().take_changed(changed);
        processor.show(held.pool, changed, camera, session.scene_time(), held.motions, expected, repainted);
        card.show(held.pool, changed, camera, session.scene_time(), held.motions, unused, repainted, &canvas);
        held.pool.note_shown(processor.shown_blocks());
    }
};

class GpuCanvasTest : public testing::Test {
protected:
    void SetUp() override {
        context_.emplace();
        if (!context_->is_there()) {
            GTEST_SKIP() << "there is no OpenGL 3.3";
        }
        canvas_.emplace();
    }
    void TearDown() override { canvas_.reset(); }

    /// Checks the errors of every fifth of so many pictures, seen by a camera that goes as `camera_at` tells.
    void compare(std::string const& scene, int pictures,
                 std::function<Camera(SceneSession&, double)> const& camera_at) {
        Both both(scene);
        int compared = 0, differing_tiles = 0, all_tiles = 0;
        std::vector<float> depths;
        for (int picture = 0; picture < pictures; ++picture) {
            double const now = picture / 30.0;
            both.show(now, camera_at(both.session, now), true, *canvas_);
            if (picture % 5 != 4 || !both.card.is_on_canvas()) {
                continue;
            }
            ++compared;
            canvas_->read(both.painted);
            Difference const error = difference(both.expected, both.painted);
            EXPECT_LT(error.absolute, 1e-4) << scene << ' ' << picture;
            EXPECT_LT(error.squared, 1e-4) << scene << ' ' << picture;
            canvas_->read_inverse_depths(depths);
            EXPECT_TRUE(std::ranges::all_of(
                depths, [](float value) { return value == hole_depth || (value >= 0 && std::isfinite(value)); }))
                << scene << ' ' << picture;
            int const strayed = strayed_pixels(depths, both.processor.inverse_depth()) +
                                strayed_pixels(both.processor.inverse_depth(), depths);
            EXPECT_LE(strayed, most_strayed) << scene << ' ' << picture;
            EXPECT_NEAR(both.card.hole_share(), both.processor.hole_share(), 1e-4) << scene << ' ' << picture;
            for (std::size_t slot = 0; slot < both.held.pool.slot_count(); ++slot) {
                std::vector<Tile> const shown = shown_of(both.card, slot), expected = shown_of(both.processor, slot);
                std::vector<Tile> differing;
                std::ranges::set_symmetric_difference(shown, expected, std::back_inserter(differing), {}, &Tile::code,
                                                      &Tile::code);
                differing_tiles += static_cast<int>(differing.size());
                all_tiles += static_cast<int>(expected.size());
            }
        }
        EXPECT_GT(compared, 0) << scene;
        EXPECT_LE(differing_tiles, all_tiles / 50) << scene;
    }

    std::optional<GlContext> context_;
    std::optional<GpuCanvas> canvas_;
};

TEST_F(GpuCanvasTest, PaintsAsTheProcessorWhereTheCameraGoesWithTheScene) {
    for (std::string const scene : {"vehicle_chase", "windmill", "foliage", "globe"}) {
        compare(scene, 25, [](SceneSession& session, double now) { return session.camera_at(now); });
    }
}

TEST_F(GpuCanvasTest, PaintsAsTheProcessorWhereTheCameraStands) {
    for (std::string const scene : {"windmill", "vehicle_crossing"}) {
        compare(scene, 20, [](SceneSession& session, double) { return session.camera_at(0); });
    }
}

/// The camera turns towards what was never seen: much of the picture is made up.
TEST_F(GpuCanvasTest, PaintsAsTheProcessorWhereTheCameraTurnsQuickly) {
    compare("vehicle_chase", 15, [](SceneSession& session, double now) {
        Camera camera = session.camera_at(now);
        camera.orientation = camera.orientation * glm::angleAxis(static_cast<float>(1.2 * now), Vec3(0, 1, 0));
        camera.position += camera.orientation * Vec3(0, 0, static_cast<float>(now));
        return camera;
    });
}

TEST_F(GpuCanvasTest, WhatIsInMemoryStaysThere) {
    Both both("windmill");
    Camera const camera = both.session.camera_at(0);
    for (int picture = 0; picture < 5; ++picture) {
        both.show(picture / 30.0, camera, false, *canvas_);
    }
    EXPECT_FALSE(both.card.is_on_canvas()) << "nothing moves";
    EXPECT_EQ(both.unused, both.expected);
}

TEST_F(GpuCanvasTest, MakesNothingNewWhereNothingNewIsHeld) {
    Both both("windmill");
    double now = 0;
    for (int picture = 0; picture < 20; ++picture, now += 1 / 30.0) {
        both.show(now, both.session.camera_at(now), true, *canvas_);
    }
    Camera camera = both.session.camera_at(now);
    auto const show_moved = [&] {
        camera.position.x += 0.001f;
        both.card.show(both.held.pool, {}, camera, now, both.held.motions, both.unused, both.repainted, &*canvas_);
        EXPECT_TRUE(both.card.is_on_canvas());
        EXPECT_FALSE(both.repainted.empty());
    };
    show_moved();
    std::size_t const made = canvas_->made_objects();
    for (int picture = 0; picture < 10; ++picture) {
        show_moved();
    }
    EXPECT_EQ(canvas_->made_objects(), made);
}

TEST_F(GpuCanvasTest, APictureStaysUntilOneOfAnotherSizeIsAskedFor) {
    canvas_->begin(this, true, {64, 48});
    std::uint32_t const first = canvas_->texture();
    canvas_->begin(this, false, {80, 48});
    canvas_->begin(this, false, {96, 48});
    EXPECT_NE(glIsTexture(first), GL_FALSE) << "it may be on the display";
    std::uint32_t const third = canvas_->texture();
    EXPECT_NE(third, first);
    canvas_->begin(this, false, {64, 48});
    EXPECT_EQ(glIsTexture(first), GL_FALSE);
    EXPECT_NE(glIsTexture(third), GL_FALSE);
}

} // namespace
} // namespace framelet
