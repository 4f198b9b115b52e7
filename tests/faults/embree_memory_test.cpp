// Embree has no memory for a while: nothing is shown meanwhile, viewers are told to come again, and then all is as it
// was, without a restart.
#include <atomic>
#include <thread>

#include <dlfcn.h>
#include <gtest/gtest.h>

#include "server/render/framelet_renderer.h"
#include "server/render/surface/embree_api.h"
#include "server/scene/scene_import.h"
#include "server/stream/posed_scene.h"
#include "tests/session/raw_viewer.h"
#include "tests/session/running_server.h"

namespace {

std::atomic<bool> is_short = false; ///< Embree is given no memory

bool permit(void*, ssize_t bytes, bool) {
    return bytes <= 0 || !is_short;
}

} // namespace

/// Stands in for the library's function: each device of this program asks before it takes memory.
RTC_API RTCDevice rtcNewDevice(char const* config) {
    static auto const original = reinterpret_cast<RTCDevice (*)(char const*)>(::dlsym(RTLD_NEXT, "rtcNewDevice"));
    RTCDevice const device = original(config);
    rtcSetDeviceMemoryMonitorFunction(device, permit, nullptr);
    return device;
}

namespace framelet::test {
namespace {

class Shortage {
public:
    Shortage() { is_short = true; }
    ~Shortage() { is_short = false; }
};

/// A sheet that a bone bends, beside a row of sheets that stand still and one that turns.
Scene bent_scene(int standing) {
    Scene scene;
    scene.materials.emplace_back();
    scene.materials[0].double_sided = true;
    Primitive sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {1, 2, 0}};
    sheet.normals.assign(4, {0, 0, 1});
    sheet.triangles = {{0, 1, 2}, {2, 1, 3}};
    Primitive bent = sheet;
    bent.influences.resize(4);
    for (std::size_t i = 0; i < 4; ++i) {
        bent.influences[i].joints = {0, 0, 0, 0};
        bent.influences[i].weights = {1, 0, 0, 0};
    }
    scene.meshes.push_back({"bent", {bent}, {}});
    scene.meshes.push_back({"sheet", {sheet}, {}});
    scene.nodes.resize(2 + static_cast<std::size_t>(standing));
    scene.nodes[0].mesh = 0;
    scene.nodes[0].skin = 0;
    scene.skins.push_back({{1}, {Mat4(1)}});
    for (std::size_t i = 2; i < scene.nodes.size(); ++i) {
        scene.nodes[i].mesh = 1;
        scene.nodes[i].local.translation = {1.5f * static_cast<float>(i - 1), 0, -static_cast<float>(i)};
    }
    return scene;
}

Picture picture_of(RenderScene const& scene) {
    return render_picture(scene, look_at({2, 1, 8}, {2, 1, 0}, {0, 1, 0}, 0.9f), {160, 96}, 1, 1);
}

/// The parameter is the number of instances beside the bent one: few, and so many that those which move have a level of
/// their own.
class EmbreeMemory : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Standing, EmbreeMemory, testing::Values(3, 300));

TEST_P(EmbreeMemory, WhereItIsThereAgainTheSceneIsAsItWas) {
    Scene const scene = bent_scene(GetParam());
    RenderScene rendered(scene, std::nullopt);
    ScenePose poses[3];
    for (std::size_t i = 0; i < 3; ++i) {
        poses[i] = evaluate_pose(scene, {}, 0);
        poses[i].world_from_node[1][3] = Vec4(0.3f * static_cast<float>(i), 0, static_cast<float>(i), 1);
        poses[i].world_from_node[2][3].y += 0.5f * static_cast<float>(i);
    }
    std::vector<Picture> pictures;
    for (ScenePose const& pose : poses) {
        rendered.set_pose(pose);
        pictures.push_back(picture_of(rendered));
    }
    ASSERT_NE(pictures[0], pictures[1]);
    ASSERT_NE(pictures[1], pictures[2]);
    {
        Shortage const shortage;
        for (int attempt = 0; attempt < 3; ++attempt) {
            EXPECT_THROW(rendered.set_pose(poses[0]), std::bad_alloc);
        }
    }
    for (std::size_t i : {1, 0, 2}) {
        rendered.set_pose(poses[i]);
        EXPECT_EQ(picture_of(rendered), pictures[i]);
    }
}

/// True once the server is well, or not well; false where that does not come.
bool becomes(RunningServer const& server, bool healthy) {
    auto const deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (server.figures().healthy != healthy) {
        if (std::chrono::steady_clock::now() > deadline) {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

/// Looks until a batch of this camera has come, or the server ends the session, and returns what it says then.
std::optional<Failure> look(RawViewer& viewer, std::uint64_t number) {
    viewer.send(CameraUpdate{{number, Camera{}, {64, 48}}, -1});
    std::optional<Failure> failure;
    bool const seen = viewer.watch([&](Message const& message) {
        if (auto const* const said = std::get_if<Failure>(&message)) {
            failure = *said;
        }
        auto const* const batch = std::get_if<EncodedBatch>(&message);
        return failure || (batch != nullptr && batch->moment && batch->moment->view.number == number);
    });
    return seen ? failure : Failure{"the connection has ended"};
}

TEST(EmbreeMemory, ViewersAreToldToComeAgainAndAreServedThen) {
    RunningServer const server({}, moving_scene());
    RawViewer first(server.port());
    ASSERT_FALSE(look(first, 1));
    EXPECT_TRUE(becomes(server, true));
    {
        Shortage const shortage;
        auto const end = look(first, 2);
        ASSERT_TRUE(end);
        EXPECT_NE(end->text.find("memory"), std::string::npos) << end->text;
        EXPECT_TRUE(end->again) << "what is missing is not for its picture";
        RawViewer second(server.port());
        auto const other_end = look(second, 1);
        ASSERT_TRUE(other_end);
        EXPECT_TRUE(other_end->again) << other_end->text;
        EXPECT_TRUE(becomes(server, false));
    }
    EXPECT_TRUE(becomes(server, true)) << "nobody has to come first";
    RawViewer third(server.port());
    auto const end = look(third, 1);
    EXPECT_FALSE(end) << end->text;
}

} // namespace
} // namespace framelet::test
