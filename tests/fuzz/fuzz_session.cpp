// A server after hello: a session whose viewer says whatever it likes, its stream on a virtual clock. Input: bodies of
// messages, each with its length, two bytes, in front; none is there where that is 0. After each of them time passes,
// and the stream gets its turn.
#include <algorithm>

#include <tbb/global_control.h>

#include "common/error.h"
#include "protocol/messages/message_codec.h"
#include "server/scene/motion/animation.h"
#include "server/session/clock/clock_requests.h"
#include "server/session/clock/scene_clock.h"
#include "server/session/limits/session_memory.h"
#include "server/session/loop/contained.h"
#include "server/stream/framelet_stream.h"
#include "tests/session/fake_stream.h"
#include "tests/session/triangle_scenes.h"

namespace {

using namespace framelet;

/// Most pixels of a picture: larger ones are refused, so that one input takes little time.
constexpr int most_pixels = 160 * 120;
constexpr std::size_t most_turns = 64;
constexpr double turn_seconds = 0.01;

struct Served {
    Scene scene = moving_scene();
    RenderScene render_scene{scene, std::nullopt};
    PosedScene posed{scene, default_clips(scene), render_scene};
};

/// A viewer, with what the server and its loop do for it.
class Viewer {
public:
    explicit Viewer(Served& served) : served_(served) {
        Session::Events events;
        events.admit = [](Hello const&) { return Welcome{}; };
        events.clock_request = [this](ClockRequest const& request) {
            clock_.apply(request, time());
            session_->note_clock_change();
        };
        events.resize = [this](Viewport viewport, bool predicts) -> std::optional<std::string> {
            if (viewport.width * viewport.height > most_pixels) {
                return "too large";
            }
            return memory_.reserve(1, viewport, predicts);
        };
        events.changed = [] {};
        events.ended = [this](std::string const& reason) {
            FRAMELET_CHECK(!reason.empty() && reason.find('\n') == std::string::npos);
            ++ends_;
        };
        session_ = std::make_shared<Session>(1, connection_, std::move(events));
        session_->start();
        connection_->bring(Hello{protocol_version, {}, coding::all});
    }

    ~Viewer() { connection_->forget_handlers(); }

    bool is_open() const { return session_->is_open(); }
    int ends() const { return ends_; }
    void say(Message const& message) { connection_->bring(message); }

    /// Gives the viewer a turn. What fails in it is our own mistake: no viewer may lead to an exception.
    void take_turn() {
        now_ += turn_seconds;
        session_->take_events(events_);
        for (StreamEvent& event : events_) {
            event.seconds = now_;
            stream_.take(event);
        }
        ClockState const clock = clock_.state(time());
        double const speed = clock.playing ? double{clock.speed} : 0;
        if (stream_.plan({now_, clock.time, speed, 2e5, 1e-4}, served_.posed) != Step::render) {
            return;
        }
        served_.posed.pose(stream_.moment());
        stream_.render(served_.posed);
        if (stream_.learn(served_.posed)) {
            EncodedBatch batch = stream_.encode();
            encode_message(batch); // it can be sent
            session_->send_batch(std::move(batch));
        }
        session_->status();
    }

private:
    WallTime time() const {
        return WallTime(std::chrono::duration_cast<WallTime::duration>(std::chrono::duration<double>(now_)));
    }

    Served& served_;
    double now_ = 0;
    int ends_ = 0;
    std::shared_ptr<FakeStream> const connection_ = std::make_shared<FakeStream>();
    std::shared_ptr<Session> session_;
    SessionMemory memory_{64'000'000};
    SceneClock clock_{true, WallTime{}};
    FrameletStream stream_{StreamOptions{}, coding::all};
    std::vector<StreamEvent> events_;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    static tbb::global_control const threads(tbb::global_control::max_allowed_parallelism, 1);
    static Served served;
    Viewer viewer(served);
    for (std::size_t turn = 0; size >= 2 && turn < most_turns && viewer.is_open(); ++turn) {
        std::size_t const length = std::min(data[0] | std::size_t{data[1]} << 8, size - 2);
        ByteView const body{reinterpret_cast<std::byte const*>(data + 2), length};
        data += 2 + length;
        size -= 2 + length;
        try {
            if (!body.empty()) {
                viewer.say(decode_message(body));
            }
        } catch (ProtocolError const&) {
            break; // which ends the connection
        }
        if (viewer.is_open()) {
            viewer.take_turn();
        }
    }
    FRAMELET_CHECK(viewer.ends() == (viewer.is_open() ? 0 : 1));
    return 0;
}
