// A viewer behind a slow link beside one that takes exact samples alone: what both show in the end.
#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

#include <boost/asio/ip/tcp.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "common/held/framelet_cache.h"
#include "common/picture/reconstruction.h"
#include "protocol/codec/batch_codec.h"
#include "protocol/stream/stream_opening.h"
#include "server/scene/scene_import.h"
#include "server/session/server.h"
#include "tests/evaluation/codecs/link_emulator.h"
#include "tests/session/raw_viewer.h"
#include "tests/session/running_server.h"

namespace framelet {
namespace {

namespace asio = boost::asio;
using namespace std::chrono_literals;
using std::chrono::steady_clock;

constexpr Viewport viewport{192, 108};
constexpr std::uint64_t cameras = 60;

CameraUpdate camera_update(std::uint64_t number) {
    float const turn = 0.01f * static_cast<float>(cameras - number);
    return {{number, look_at({9 + turn, 4, 12 - turn}, {0, 1, 0}, {0, 1, 0}, 0.9f), viewport}, -1};
}

struct Shown {
    Picture picture;
    bool converged = false;
    std::size_t lossy = 0; ///< framelets that came with loss
    std::size_t predicted = 0; ///< batches that were predicted
};

/// Looks through one camera after the other, a new one with every batch, until the last one's picture is complete.
Shown watch(std::uint16_t port, std::uint32_t codings) {
    asio::io_context io{1};
    asio::ip::tcp::socket socket(io);
    socket.connect({asio::ip::make_address("127.0.0.1"), port});
    auto const stream = plain_stream(std::move(socket));
    BatchCodec codec;
    BatchMemory held;
    FrameletCache cache{ImagePlane(viewport)};
    Shown shown;
    std::uint64_t newest = 0, camera = 1;
    auto const receive = [&](Message const& message) {
        if (std::holds_alternative<Welcome>(message)) {
            stream->send(camera_update(camera));
        } else if (auto const* const encoded = std::get_if<EncodedBatch>(&message)) {
            auto const received =
                std::chrono::duration_cast<std::chrono::microseconds>(steady_clock::now().time_since_epoch());
            Batch const batch = codec.decode(*encoded, &held);
            shown.predicted += encoded->encoding == SampleEncoding::predicted ? 1 : 0;
            cache.insert(batch);
            newest = batch.number;
            shown.lossy += batch.qp.size() - static_cast<std::size_t>(std::ranges::count(batch.qp, 0));
            stream->send(Ack{newest, static_cast<std::uint64_t>(received.count()), 0});
            if (camera < cameras) {
                stream->send(camera_update(++camera));
            }
        } else if (auto const* const status = std::get_if<Status>(&message)) {
            if (status->converged && status->camera_number == cameras && status->last_batch == newest) {
                shown.converged = true;
                stream->close();
                io.stop();
            }
        }
    };
    stream->start({receive, [&io](std::string const&) { io.stop(); }, {}}, max_message_bytes);
    stream->send(Hello{protocol_version, {}, codings});
    io.run_for(120s);
    std::vector<PixelRect> changed;
    cache.take_changed(changed);
    shown.picture = Picture(viewport.width, viewport.height);
    reconstruct(cache, changed, shown.picture);
    return shown;
}

/// The parameter is the number of threads: one, few, and so many that a batch is planned before the last one is learnt.
class LossyDelivery : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Threads, LossyDelivery, testing::Values(1, 2, 8));

TEST_P(LossyDelivery, ConvergesToTheExactPicture) {
#ifdef FRAMELET_SANITIZE
    GTEST_SKIP() << "a server that is as slow as this has a link that is fast enough for all to be exact";
#endif
    tbb::global_control const threads(tbb::global_control::max_allowed_parallelism, GetParam());
    Scene const scene = import_scene(FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb");
    RenderScene render_scene(scene, std::nullopt);
    PosedScene posed(scene, {}, render_scene);
    ServerOptions options;
    options.port = 0;
    options.paused = true;
    Server server(posed, options);
    std::jthread const running([&server] { server.run(); });
    Shown const exact = watch(server.port(), coding::exact_colour);
    bench::LinkEmulator const link(server.port(), {.bits_per_second = 1.5e6, .delay_seconds = 0.002});
    EXPECT_TRUE(exact.converged);
    EXPECT_EQ(exact.lossy, 0u);
    for (std::uint32_t const predicted : {0u, coding::predicted_colour}) {
        Shown const lossy = watch(link.port(), coding::exact_colour | coding::haar_colour | predicted);
        EXPECT_TRUE(lossy.converged);
        EXPECT_GT(lossy.lossy, 0u) << "the link is too slow for all to be exact";
        EXPECT_EQ(lossy.predicted > 0, predicted != 0);
        EXPECT_EQ(lossy.picture.rgba, exact.picture.rgba);
    }
    server.stop();
}

/// Batches that have been sent wait out the stalls, and whoever is cut off amid a message starts anew.
TEST(BadLink, StallsRateStepsAndCutsAmidAMessageEndInTheExactPicture) {
    ServerOptions options;
    options.paused = true;
    RunningServer const server(options, import_scene(FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb"));
    Shown const exact = watch(server.port(), coding::exact_colour);
    ASSERT_TRUE(exact.converged);
    bench::LinkParameters const bad{.bits_per_second = 2e6,
                                    .delay_seconds = 0.005,
                                    .jitter_seconds = 0.01,
                                    .stalls = {{0.1, 0.4}, {0.8, 0.3}},
                                    .rate_steps = {{0.6, 0.3e6}, {1.2, 4e6}}};
    for (int cuts = 0; cuts < 5; ++cuts) {
        bench::LinkEmulator const link(server.port(), bad);
        RawViewer viewer(link.port());
        viewer.send(CameraUpdate{{1, Camera{}, {1280, 720}}, -1});
        ASSERT_TRUE(viewer.receive()) << "it is welcome";
        // The first batches of so large a picture are on their way until after the first stall.
        std::this_thread::sleep_for(std::chrono::milliseconds(20 + 60 * cuts));
    }
    bench::LinkEmulator const link(server.port(), bad);
    Shown const shown = watch(link.port(), coding::exact_colour | coding::haar_colour | coding::predicted_colour);
    EXPECT_TRUE(shown.converged);
    EXPECT_EQ(shown.picture.rgba, exact.picture.rgba);
}

} // namespace
} // namespace framelet
