// A server without sockets and threads: viewers say whatever they like, from their hello on, and come back with
// tickets, while their streams run on a virtual clock. The form of the input is in session_input.h. After each message
// time passes, and the streams get their turns.
#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <spdlog/spdlog.h>
#include <tbb/global_control.h>

#include "common/error.h"
#include "protocol/messages/message_codec.h"
#include "server/scene/motion/animation.h"
#include "server/session/admission.h"
#include "server/session/clock/scene_clock.h"
#include "server/session/welcome.h"
#include "server/stream/framelet_stream.h"
#include "server/workers/order_tracing.h"
#include "server/workers/worker_pool.h"
#include "tests/fuzz/session_input.h"
#include "tests/session/fake_stream.h"
#include "tests/session/triangle_scenes.h"

namespace {

using namespace framelet;
using std::chrono::steady_clock;

/// Pictures of more pixels are refused, so that one input takes little time.
constexpr Viewport largest{160, 120};
constexpr std::size_t places = 2;
constexpr std::size_t most_open = 32; ///< with those who have no pictures
constexpr std::size_t most_turns = 64;
/// Connections over which what is repeated is said.
constexpr std::size_t repeats = 256;
/// Most messages and framelets of Evicted that may wait for a viewer's turn.
constexpr std::size_t most_evicted = std::size_t{1} << 18;
constexpr double turn_seconds = 0.01;

struct Served {
    Scene scene = moving_scene();
    RenderScene render_scene{scene, std::nullopt};
    PosedScene posed{scene, default_clips(scene), render_scene};
    Welcome welcome = make_welcome(scene, default_clips(scene));
};

/// A connection over which all goes that can be sent; what cannot is our own mistake.
class EncodingStream final : public FakeStream {
public:
    std::size_t send(Message const& message) override { return encode_message(message).size(); }
};

/// What the server does with its connections, and its loop with the sessions. What fails there is our own mistake: no
/// viewer may lead to an exception.
class SocketlessServer {
public:
    SocketlessServer(Served& served, Admission::Rules const& rules)
        : served_(served), rules_(rules), admission_(rules, [] {}) {}

    ~SocketlessServer() {
        for (auto const& [id, connection] : connections_) {
            connection.stream->forget_handlers();
        }
    }

    /// Opens a connection, over which the following is said.
    void connect() {
        speaker_ = next_id_++;
        auto const stream = std::make_shared<EncodingStream>();
        auto const session = std::make_shared<Session>(speaker_, stream, events_of(speaker_));
        connections_[speaker_] = {stream, session};
        said_.clear();
        session->start();
    }

    /// Says what has been said over this connection over many others, before there is a turn.
    void repeat() {
        std::vector<ByteView> const said = said_;
        for (std::size_t times = 0; times < repeats && !said.empty(); ++times) {
            connect();
            for (ByteView const body : said) {
                say(body);
            }
        }
    }

    void cut() { lose("the connection was cut", true); }

    void say(ByteView body) {
        auto const speaker = connections_.find(speaker_);
        if (speaker == connections_.end()) {
            return;
        }
        said_.push_back(body);
        std::optional<Message> message;
        try {
            message = decode_message(body);
        } catch (ProtocolError const& error) {
            lose(error.what(), false);
            return;
        }
        if (auto* const hello = std::get_if<Hello>(&*message)) {
            set_ticket(*hello);
        }
        speaker->second.stream->bring(*message);
        remove_ended();
    }

    void take_turns() {
        now_ += turn_seconds;
        work();
        std::erase_if(viewers_, [](auto const& entry) { return !entry.second.session->is_served(); });
        for (auto const& session : open_sessions()) {
            if (session->is_ready()) {
                take_turn(*session, stream_of(session));
            }
        }
        remove_ended();
    }

    /// Ends all sessions. Nothing may be left of what they had: there is memory for as many others.
    void end_all() {
        for (auto const& session : open_sessions()) {
            session->close("the server shuts down");
            remove(session->id());
        }
        admission_.keep_parked(0);
        for (std::size_t i = 0; i < places; ++i) {
            FRAMELET_CHECK(!admission_.reserve(next_id_++, largest, true));
        }
    }

private:
    struct Connection {
        std::shared_ptr<EncodingStream> stream;
        std::shared_ptr<Session> session;
    };
    struct Viewer {
        std::shared_ptr<Session> session;
        std::unique_ptr<FrameletStream> stream;
    };

    Session::Events events_of(std::uint64_t id) {
        Session::Events events;
        events.admit = [this, id](Hello const& hello) { return admit(id, hello); };
        events.clock_request = [this, id](ClockRequest const& request) {
            if (admission_.controls(id)) {
                clock_.apply(request, time());
                for (auto const& session : open_sessions()) {
                    session->note_clock_change();
                }
            }
        };
        events.resize = [this, id](Viewport viewport, bool predicts) -> std::optional<std::string> {
            bool const fits = viewport.width * viewport.height <= largest.width * largest.height;
            return fits ? admission_.reserve(id, viewport, predicts) : "too large";
        };
        events.changed = [] {};
        events.path_answer = [this, id](PathAnswer answer) { workers_.answer(id, std::move(answer)); };
        events.ended = [this, id](std::string const& reason) {
            FRAMELET_CHECK(!reason.empty() && reason.find('\n') == std::string::npos);
            FRAMELET_CHECK(ended_.insert(id).second); // each is told once
        };
        return events;
    }

    std::variant<Welcome, Failure> admit(std::uint64_t id, Hello const& hello) {
        if (auto const refusal = admission_.refusal(hello, "somebody", steady_clock::now())) {
            return *refusal;
        }
        bool const may_control = !rules_.control_token.empty() && hello.token == rules_.control_token;
        FRAMELET_CHECK(rules_.token.empty() || hello.token == rules_.token || may_control);
        if (auto const before = admission_.session_left_behind(hello)) {
            before->cut();
            remove(before->id());
        }
        if (hello.work || hello.codings == coding::none) {
            return admit_without_pictures(id, hello.work.has_value());
        }
        if (viewers_here() >= places) {
            return Failure{"the server has its viewers already", true};
        }
        Welcome answer = served_.welcome;
        answer.clock = clock_.state(time());
        admission_.seat(connections_.at(id).session, hello, answer);
        FRAMELET_CHECK(answer.ticket && answer.resumed == (answer.ticket == hello.ticket));
        tickets_.push_back(answer.ticket);
        return answer;
    }

    /// Lets in a worker, or who hears the clock alone.
    std::variant<Welcome, Failure> admit_without_pictures(std::uint64_t id, bool is_worker) {
        if (static_cast<std::size_t>(open_sessions().size()) >= most_open) {
            return Failure{"there are too many", true};
        }
        if (is_worker) {
            auto const session = connections_.at(id).session;
            workers_.join(id, {1, [session](PathOrder const& order) { session->send(order); },
                               [session](std::string const& reason) { session->end(reason); }});
        }
        return served_.welcome;
    }

    std::size_t viewers_here() const {
        auto const open = open_sessions();
        return static_cast<std::size_t>(
            std::ranges::count_if(open, [](auto const& session) { return session->has_pictures(); }));
    }

    /// A round for the workers that are here, which numbers its orders as the rounds before: what is said fits some.
    void work() {
        if (workers_.workers() == 0) {
            return;
        }
        std::vector<PathOrder> orders(4);
        for (PathOrder& order : orders) {
            order.view.viewport = {64, 48};
            order.tiles = {{Tile{1}, 0}};
        }
        std::size_t done = 0;
        std::vector<TileLight> light(1);
        workers_.begin(orders);
        workers_.finish([&](std::size_t) { ++done; },
                        [&](std::size_t, PathAnswer const& answer) {
                            bool const is_light = read_tiles(answer, light);
                            done += is_light ? 1 : 0;
                            return is_light;
                        });
        FRAMELET_CHECK(done == orders.size());
    }

    /// Replaces a ticket that is a small number by that of the welcome of this number. Nobody could guess it.
    void set_ticket(Hello& hello) const {
        std::uint64_t const number = hello.ticket.low;
        if (hello.ticket.high == 0 && number >= 1 && number <= tickets_.size()) {
            hello.ticket = tickets_[number - 1];
        }
    }

    void lose(std::string const& reason, bool is_cut) {
        if (auto const speaker = connections_.find(speaker_); speaker != connections_.end()) {
            speaker->second.stream->lose(reason, is_cut);
            remove_ended();
        }
    }

    /// Removes those that have ended, which is not done while a session is on the stack. Each of them has told so.
    void remove_ended() {
        for (std::uint64_t const id : ended_) {
            remove(id);
        }
        FRAMELET_CHECK(
            std::ranges::none_of(connections_, [](auto const& entry) { return entry.second.session->has_ended(); }));
    }

    void remove(std::uint64_t id) {
        auto const node = connections_.extract(id);
        if (!node.empty()) {
            workers_.leave(id);
            admission_.leave(id, node.mapped().session.get());
            node.mapped().stream->forget_handlers();
            admission_.keep_parked(places);
        }
    }

    std::vector<std::shared_ptr<Session>> open_sessions() const {
        std::vector<std::shared_ptr<Session>> open;
        for (auto const& [id, connection] : connections_) {
            if (connection.session->is_open()) {
                open.push_back(connection.session);
            }
        }
        return open;
    }

    FrameletStream& stream_of(std::shared_ptr<Session> const& session) {
        Viewer& viewer = viewers_[session->id()];
        if (!viewer.stream) {
            viewer.session = session;
            auto const earlier = session->earlier();
            viewer.stream = earlier ? take_up(*session, *earlier) : new_stream(*session);
        }
        return *viewer.stream;
    }

    static std::unique_ptr<FrameletStream> new_stream(Session const& session) {
        return std::make_unique<FrameletStream>(StreamOptions{}, session.codings());
    }

    /// Takes the stream of the session with which this one goes on, and which has nothing to go on with itself.
    std::unique_ptr<FrameletStream> take_up(Session& session, Session& earlier) {
        FRAMELET_CHECK(!earlier.earlier());
        bool const is_taken = session.take_over(earlier);
        FRAMELET_CHECK(is_taken);
        auto node = viewers_.extract(earlier.id());
        return node.empty() ? new_stream(earlier) : std::move(node.mapped().stream);
    }

    void take_turn(Session& session, FrameletStream& stream) {
        session.take_events(events_);
        std::size_t evicted = 0;
        for (StreamEvent const& event : events_) {
            auto const* const gone = std::get_if<Evicted>(&event.what);
            evicted += gone != nullptr ? gone->framelets.size() + 1 : 0;
        }
        FRAMELET_CHECK(evicted <= most_evicted);
        for (StreamEvent& event : events_) {
            event.seconds = now_;
            stream.take(event);
        }
        ClockState const clock = clock_.state(time());
        double const speed = clock.playing ? double{clock.speed} : 0;
        if (stream.plan({now_, clock.time, speed, 2e5, 1e-4}, served_.posed) != Step::render) {
            return;
        }
        served_.posed.pose(stream.moment());
        stream.render(served_.posed);
        if (stream.learn(served_.posed)) {
            session.send_batch(stream.encode());
        }
        session.send(session.status());
    }

    WallTime time() const {
        return WallTime(std::chrono::duration_cast<WallTime::duration>(std::chrono::duration<double>(now_)));
    }

    Served& served_;
    Admission::Rules const rules_;
    Admission admission_;
    WorkerPool workers_;
    SceneClock clock_{true, WallTime{}};
    double now_ = 0;
    std::uint64_t next_id_ = 1, speaker_ = 0;
    std::vector<ByteView> said_; ///< by the speaker
    std::map<std::uint64_t, Connection> connections_;
    std::set<std::uint64_t> ended_; ///< all that have told so
    std::vector<Ticket> tickets_; ///< of all welcomes
    std::map<std::uint64_t, Viewer> viewers_; ///< by session, parked ones too
    std::vector<StreamEvent> events_; ///< scratch
};

/// `bits`: the input's first byte.
Admission::Rules rules_of(unsigned bits) {
    auto const if_set = [bits](unsigned bit, char const* text) { return (bits & bit) != 0 ? text : ""; };
    return {if_set(session_input::asks_for_token, session_input::token),
            if_set(session_input::has_control_token, session_input::control_token),
            (bits & session_input::shares_control) != 0, places * session_bytes(largest, true)};
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    static tbb::global_control const threads(tbb::global_control::max_allowed_parallelism, 1);
    static Served served;
    spdlog::set_level(spdlog::level::off);
    if (size < 1) {
        return 0;
    }
    SocketlessServer server(served, rules_of(data[0]));
    server.connect();
    ByteView rest = std::as_bytes(std::span(data, size)).subspan(1);
    for (std::size_t turn = 0; rest.size() >= 2 && turn < most_turns; ++turn) {
        unsigned const head = std::to_integer<unsigned>(rest[0]) | std::to_integer<unsigned>(rest[1]) << 8;
        ByteView const body =
            rest.subspan(2, std::min<std::size_t>(head & session_input::length_bits, rest.size() - 2));
        rest = rest.subspan(2 + body.size());
        if ((head & session_input::is_cut) != 0) {
            server.cut();
        }
        if ((head & session_input::connects) != 0) {
            server.connect();
        }
        if ((head & session_input::is_repeated) != 0) {
            server.repeat();
        }
        if (!body.empty()) {
            server.say(body);
        }
        server.take_turns();
    }
    server.end_all();
    return 0;
}
