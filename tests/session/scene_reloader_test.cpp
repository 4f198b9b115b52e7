// Scenes that are loaded again: what a load on its way does when the server ends.
#include <chrono>
#include <future>
#include <thread>

#include <gtest/gtest.h>

#include "common/error.h"
#include "server/session/scene_reloader.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

TEST(SceneReloader, ALoadOnItsWayEndsWithTheServer) {
    std::promise<void> begun;
    bool loaded = false;
    bool taken = false;
    auto const load = [&](Progress const& progress) -> std::shared_ptr<LoadedScene> {
        begun.set_value();
        for (int step = 0; step < 1'000; ++step) { // ten seconds: a large scene
            std::this_thread::sleep_for(10ms);
            progress("meshes", step / 1e3);
        }
        loaded = true;
        return nullptr;
    };
    {
        SceneReloader reloader({}, {"/scene.glb"}, {}, {}, load, [&](auto const&) { taken = true; });
        reloader.ask();
        begun.get_future().wait();
    }
    EXPECT_FALSE(loaded);
    EXPECT_FALSE(taken);
}

/// One that loops for ever would keep all later ones from being loaded.
TEST(SceneReloader, ALoadOnItsWayEndsForANewerRequest) {
    std::promise<void> begun, again;
    int loads = 0;
    auto const load = [&](Progress const& progress) -> std::shared_ptr<LoadedScene> {
        if (++loads > 1) {
            again.set_value();
            throw InputError("of no account");
        }
        begun.set_value();
        for (int step = 0; step < 12'000; ++step) { // two minutes, for one that never ends
            std::this_thread::sleep_for(10ms);
            progress("meshes", 0);
        }
        throw InputError("it was not ended");
    };
    SceneReloader reloader({}, {"/scene.glb"}, {}, {}, load, [](auto const&) {});
    reloader.ask();
    begun.get_future().wait();
    reloader.ask();
    EXPECT_EQ(again.get_future().wait_for(100s), std::future_status::ready);
}

} // namespace
} // namespace framelet::test
