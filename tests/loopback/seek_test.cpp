// A viewer at rest seeks: what it shows at rest again is what a viewer that has just come shows.
#include <thread>

#include <gtest/gtest.h>

#include "client/core/client_core.h"
#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

class Viewer {
public:
    explicit Viewer(std::string const& address) {
        ConnectionOptions options;
        options.server = parse_server_address(address);
        core_ = std::make_unique<ClientCore>(options);
        core_->set_view(core_->welcome().start_camera, {260, 144}, 0);
    }

    Picture go_to(double time) {
        core_->request_clock({ClockRequest::time, {time, false, 1}});
        return at_rest(time);
    }
    /// The picture of this second of the scene, once the server has no more to say about it.
    Picture at_rest(double time) {
        EXPECT_TRUE(eventually([&] {
            paint();
            ClockState const clock = core_->status().clock;
            return !clock.playing && clock.time == time && core_->is_complete();
        }));
        paint(); // what came between the picture and the answer
        return picture_;
    }

private:
    void paint() {
        core_->update_picture(picture_, changed_);
        std::this_thread::sleep_for(10ms);
    }

    std::unique_ptr<ClientCore> core_;
    Picture picture_;
    std::vector<PixelRect> changed_;
};

TEST(Seek, FromRestEndsWithThePictureOfAFreshViewer) {
    ServerProcess server(FRAMELET_SOURCE_DIR "/scenes/windmill.glb", {"--paused", "--exposure", "0"});
    Viewer viewer(server.address());
    viewer.go_to(2);
    for (double const time : {0.5, 2.0, 0.5}) {
        Picture const seen = viewer.go_to(time);
        Viewer fresh(server.address());
        EXPECT_EQ(fresh.at_rest(time), seen) << "at " << time << " s";
    }
}

} // namespace
} // namespace framelet::test
