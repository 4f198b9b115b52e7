// Compares what a viewer's stream takes of the heap with what is set aside for it.
#include "server/session/limits/session_memory.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <malloc.h>

#include "server/scene/motion/animation.h"
#include "server/scene/scene_import.h"
#include "server/stream/framelet_stream.h"

namespace framelet {
namespace {

std::size_t heap_bytes() {
    auto const heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
}

/// Most bytes of the heap that a viewer's stream takes while everything moves and it flies, then until its picture at
/// rest is complete. As much is rendered, and comes, as ten whole pictures a second have samples.
std::size_t most_held(PosedScene& scene, Viewport viewport) {
    constexpr std::uint64_t flight_turns = 250, most_turns = 4000;
    double const samples_per_second = 10.0 * viewport.width * viewport.height;
    std::size_t const before = heap_bytes();
    std::size_t most = before;
    FrameletStream stream({}, coding::all);
    stream.take({0, ViewerSettings{}});
    double now = 10;
    for (std::uint64_t turn = 1; turn < most_turns && !stream.is_complete(); ++turn, now += 0.01) {
        bool const flies = turn < flight_turns;
        if (flies) {
            float const angle = 0.01f * static_cast<float>(turn);
            Camera const camera = look_at({9 * std::cos(angle), 4, 9 * std::sin(angle)}, {0, 1, 0}, {0, 1, 0}, 0.9f);
            stream.take({now, CameraUpdate{{turn, camera, viewport}, -1}});
        }
        SceneTime const present = flies ? now - 10 : 2.5;
        if (stream.plan({now, present, flies ? 1.0 : 0.0, samples_per_second, 1e-4}, scene) != Step::render) {
            continue;
        }
        scene.pose(stream.moment());
        stream.render(scene);
        if (stream.learn(scene)) {
            EncodedBatch const batch = stream.encode();
            stream.take({now, BatchSent{batch.number, batch.payload.size()}});
            stream.take({now + 0.001, Ack{batch.number, 0, 0}});
        }
        most = std::max(most, heap_bytes());
    }
    EXPECT_TRUE(stream.is_complete());
    return most - before;
}

TEST(SessionMemory, IsWhatASessionHolds) {
    Scene const scene = import_scene(FRAMELET_SOURCE_DIR "/scenes/windmill.glb");
    RenderScene render_scene(scene, std::nullopt);
    PosedScene posed(scene, default_clips(scene), render_scene);
    most_held(posed, {64, 48}); // makes what is made once for all
    for (Viewport const viewport : {Viewport{160, 120}, Viewport{320, 240}, Viewport{480, 270}}) {
        auto const held = static_cast<double>(most_held(posed, viewport));
        // The viewer answers: no batches wait.
        auto const reserved = static_cast<double>(session_bytes(viewport, true) - 2 * most_kept_bytes);
        std::printf("%dx%d: %.1f MB are held, %.1f set aside\n", viewport.width, viewport.height, 1e-6 * held,
                    1e-6 * reserved);
        EXPECT_LT(held, reserved);
        EXPECT_GT(held, 0.4 * reserved) << "more is set aside than anybody needs";
    }
}

} // namespace
} // namespace framelet
