// Paths that are traced here and by workers: the same light, whoever traces it; what is no light is not taken.
#include <limits>

#include <gtest/gtest.h>

#include "common/error.h"
#include "server/stream/posed_scene.h"
#include "server/workers/order_tracing.h"
#include "server/workers/path_round.h"
#include "tests/session/triangle_scenes.h"
#include "tests/workers/answering_worker.h"

namespace framelet {
namespace {

constexpr Viewport viewport{64, 48};

/// A moving triangle in the light of a sky.
struct LitScene {
    explicit LitScene(LightMethod method = LightMethod::full)
        : posed(scene, {0}, render_scene, {method, 0.53f, 0.1f}) {}

    Scene const scene = moving_scene();
    RenderScene render_scene{scene, Environment::uniform(Vec3(0.3f, 0.6f, 0.9f))};
    PosedScene posed;
};

std::vector<TilePath> some_paths() {
    ImagePlane const plane(viewport);
    std::vector<TilePath> paths;
    for (std::uint32_t code = 1u << (2 * plane.pixel_depth()); code < 2u << (2 * plane.pixel_depth()); ++code) {
        for (std::uint32_t path = 0; plane.accepts({code}) && path < 3; ++path) {
            paths.push_back({{code}, path});
        }
    }
    return paths;
}

bool same(TileLight const& a, TileLight const& b) {
    return a.red == b.red && a.green == b.green && a.blue == b.blue;
}

/// What an order of one tile is answered with.
PathOrder tile_order() {
    PathOrder order;
    order.view.viewport = viewport;
    order.tiles = {some_paths().front()};
    return order;
}

TEST(PathRound, WorkersFindTheSameLight) {
    LitScene const alone(LightMethod::reference), other(LightMethod::reference);
    PathRound wanted;
    PathRound::Moment const moment{0, {1, {}, viewport}};
    wanted.begin(nullptr, *alone.posed.path_light(), moment, some_paths(), nullptr, 0);
    wanted.finish();

    WorkerPool pool;
    auto const trace = [&](PathOrder const& order) { return trace_order(*other.posed.path_light(), order); };
    AnsweringWorker one(pool, 1, trace), two(pool, 2, trace), three(pool, 3, trace);
    PathRound shared;
    shared.begin(&pool, *alone.posed.path_light(), moment, some_paths(), nullptr, 0);
    two.wait_until_done();
    shared.finish();
    EXPECT_GT(pool.paths(), 0u);
    ASSERT_EQ(shared.light().size(), wanted.light().size());
    for (std::size_t i = 0; i < wanted.light().size(); ++i) {
        ASSERT_TRUE(same(shared.light()[i], wanted.light()[i])) << i;
    }
}

TEST(PathRound, WorkersGatherForTheLightCache) {
    LitScene scene, other(LightMethod::reference);
    WorkerPool pool;
    {
        AnsweringWorker worker(pool, 1, [&](PathOrder const& order) {
            for (PlacePaths const& place : order.places) {
                GatheredPacket const here =
                    gather_packet(*scene.posed.path_light(),
                                  {{place.frame, place.position, place.normal}, place.seed, place.first, place.bright});
                GatheredPacket there;
                PathOrder single = order;
                single.places = {place};
                EXPECT_TRUE(read_places(trace_order(*other.posed.path_light(), single), {&there, 1}));
                EXPECT_EQ(there.first, here.first) << "checks are compared with it";
                EXPECT_EQ(there.light.sum.all, here.light.sum.all);
                EXPECT_EQ(there.light.squares, here.light.squares);
            }
            return trace_order(*other.posed.path_light(), order);
        });
        // Begins as `learn_light` does; then the worker has done its part before this process takes the rest.
        LightGathering& gathering = *scene.posed.light_gathering();
        std::size_t const packets = gathering.plan(1 << 14, LightCache::Use::any);
        ASSERT_GT(packets, 0u);
        PathRound round;
        round.begin(&pool, *scene.posed.path_light(), {}, {}, &gathering, packets);
        worker.wait_until_done();
        round.finish();
        gathering.finish();
        EXPECT_GT(pool.paths(), 0u);
    }
    int slices = 0;
    while (scene.posed.learn_light(&pool) && slices < 20'000) {
        ++slices;
    }
    EXPECT_LT(slices, 20'000) << "it is learnt without the worker";
}

TEST(OrderTracing, WhatIsNoLightIsNotTaken) {
    LitScene const scene(LightMethod::reference);
    PathOrder const order = tile_order();
    PathAnswer const right = trace_order(*scene.posed.path_light(), order);
    std::vector<TileLight> tiles(1);
    EXPECT_TRUE(read_tiles(right, tiles));
    for (float const wrong :
         {-1e-3f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        PathAnswer answer = right;
        answer.light[77] = wrong;
        EXPECT_FALSE(read_tiles(answer, tiles)) << wrong;
    }
    PathAnswer longer = right;
    longer.light.push_back(0);
    EXPECT_FALSE(read_tiles(longer, tiles));
    EXPECT_FALSE(read_tiles({}, tiles));
    std::vector<GatheredPacket> places(1);
    EXPECT_FALSE(read_places(right, places));
    EXPECT_FALSE(read_places({0, 0, std::vector<float>(sizeof(GatheredPacket) / sizeof(float))}, places))
        << "of no paths";
}

TEST(OrderTracing, APlaceOnABodyThatIsNotThereIsRefused) {
    LitScene const scene(LightMethod::reference);
    PathOrder order;
    order.places = {{1, {0, 0, 0}, {0, 1, 0}, 0, 0, 1}};
    EXPECT_NO_THROW(trace_order(*scene.posed.path_light(), order));
    order.places.front().frame = 1000;
    EXPECT_THROW(trace_order(*scene.posed.path_light(), order), ProtocolError);
}

TEST(PosedScene, ItsLightHasAnIdentity) {
    LitScene const one(LightMethod::reference), same_light(LightMethod::full), direct(LightMethod::direct);
    EXPECT_NE(one.posed.light_identity(), 0u);
    EXPECT_EQ(one.posed.light_identity(), same_light.posed.light_identity());
    EXPECT_EQ(direct.posed.light_identity(), 0u);
    Scene const scene = moving_scene();
    RenderScene brighter(scene, Environment::uniform(Vec3(0.3f, 0.6f, 0.91f)));
    PosedScene const other(scene, {0}, brighter, {LightMethod::reference, 0.53f, 0.1f});
    EXPECT_NE(other.light_identity(), one.posed.light_identity());
    RenderScene same(scene, Environment::uniform(Vec3(0.3f, 0.6f, 0.9f)));
    PosedScene const without_clips(scene, {}, same, {LightMethod::reference, 0.53f, 0.1f});
    EXPECT_NE(without_clips.light_identity(), one.posed.light_identity()) << "at rest they are the same";
    PosedScene const other_lamps(scene, {0}, same, {LightMethod::reference, 0.53f, 0.2f});
    EXPECT_NE(other_lamps.light_identity(), one.posed.light_identity()) << "though it has none";
}

} // namespace
} // namespace framelet
