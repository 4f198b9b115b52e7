// framelet-client --tev with the real server: what a tev is shown in the end is the picture that the client writes.
#include <gtest/gtest.h>

#include "common/color.h"
#include "common/files/image_io.h"
#include "tests/client/fake_tev.h"
#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb";
constexpr auto patience = 120s;

TEST(Tev, IsShownThePictures) {
    FakeTev tev;
    ServerProcess server(scene_file, {"--paused"});
    TemporaryFolder folder;
    std::string const file = (folder.path() / "last.ppm").string();
    Process client(FRAMELET_CLIENT, {server.address(), "--size", "64x48", "--until-converged", "--duration", "100",
                                     "--output", file, "--tev", tev.address()});
    ASSERT_EQ(client.wait(patience), 0) << client.errors();
    Picture const picture = read_picture(file);
    EXPECT_TRUE(eventually([&] {
        TevImage const image = tev.image();
        bool equal = image.values.size() == 64 * 48 * 3;
        for (std::size_t i = 0; equal && i < image.values.size(); ++i) {
            equal = image.values[i] == linear_from_srgb_byte(picture.rgba[i / 3 * 4 + i % 3]);
        }
        return equal;
    }));
    EXPECT_EQ(tev.image().complaint, "");
    EXPECT_TRUE(tev.image().name.starts_with("framelet " + server.address())) << tev.image().name;
}

TEST(Tev, ThatIsNotThereIsOneLine) {
    ServerProcess server(scene_file, {"--paused"});
    Process none(FRAMELET_CLIENT, {server.address(), "--duration", "1", "--tev", "127.0.0.1:1"});
    EXPECT_EQ(none.wait(patience), 1);
    EXPECT_TRUE(none.errors().starts_with("framelet-client: cannot reach tev at 127.0.0.1:1")) << none.errors();
    Process wrong(FRAMELET_CLIENT, {server.address(), "--tev", "host:none"});
    EXPECT_EQ(wrong.wait(patience), 2);
}

} // namespace
} // namespace framelet::test
