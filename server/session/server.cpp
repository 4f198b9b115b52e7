#include "server/session/server.h"

#include <atomic>
#include <csignal>
#include <map>
#include <mutex>
#include <new>
#include <random>
#include <thread>
#include <utility>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>

#include "common/error.h"
#include "protocol/stream/stream_opening.h"
#include "protocol/stream/tls.h"
#include "protocol/stream/token.h"
#include "server/scene/motion/animation.h"
#include "server/scene/summary/scene_identity.h"
#include "server/session/clock/clock_requests.h"
#include "server/session/clock/scene_control.h"
#include "server/session/limits/farewells.h"
#include "server/session/limits/log_limit.h"
#include "server/session/limits/session_memory.h"
#include "server/session/limits/source.h"
#include "server/session/limits/tickets.h"
#include "server/session/limits/token_guesses.h"
#include "server/session/limits/waiting_room.h"
#include "server/session/listener.h"
#include "server/session/loaded_scene.h"

namespace framelet {

namespace asio = boost::asio;
using asio::ip::tcp;
using std::chrono::steady_clock;

namespace {

constexpr std::chrono::seconds heartbeat{1};
/// Without a heartbeat for so long something is wrong: a scene that is replaced holds it up for a moment.
constexpr std::chrono::seconds healthy_pause{10};
/// A connection whose bytes nobody confirms for so long is dropped by the kernel, milliseconds.
constexpr unsigned user_timeout_ms = 15000;

Welcome make_welcome(Scene const& scene, std::vector<Index> const& clips) {
    ScenePose const pose = evaluate_pose(scene, clips, 0);
    Welcome welcome;
    welcome.server = "framelet-server " FRAMELET_VERSION;
    welcome.scene_name = scene.name;
    welcome.scene_bounds = scene_bounds(scene, pose);
    for (Index i = 0; i < static_cast<Index>(scene.cameras.size()); ++i) {
        welcome.cameras.push_back({scene.cameras[static_cast<std::size_t>(i)].name, scene_camera(scene, pose, i)});
    }
    welcome.start_camera =
        welcome.cameras.empty() ? default_camera(welcome.scene_bounds) : welcome.cameras.front().camera;
    welcome.animation_duration = animation_duration(scene, clips);
    welcome.scene_identity = scene_identity(scene);
    return welcome;
}

ControlRule control_rule(ServerOptions const& options) {
    return options.shared_control          ? ControlRule::everybody
           : options.control_token.empty() ? ControlRule::first
                                           : ControlRule::token;
}

} // namespace

bool is_loopback(std::string const& bind) {
    boost::system::error_code error;
    auto const address = asio::ip::make_address(bind, error);
    return bind == "localhost" || (!error && address.is_loopback());
}

struct Server::Impl {
    std::unique_ptr<Listener> const listener;
    asio::io_context& io = listener->io;
    asio::steady_timer timer{io}, clock_timer{io};
    asio::signal_set signals{io};
    ServerOptions const options;
    std::shared_ptr<asio::ssl::context> tls;
    Welcome welcome;
    SceneClock clock;
    SceneControl control;
    ClockRequests clock_requests; ///< for the io thread only, as all down to the sessions
    SessionMemory memory;
    Tickets tickets;
    WaitingRoom waiting;
    TokenGuesses guesses;
    LogLimit wrong_tokens, turned_away, without_memory; ///< for what the log says of them
    std::minstd_rand random{std::random_device{}()};
    Farewells farewells;

    struct Connection {
        std::shared_ptr<Session> session;
        std::shared_ptr<FramedStream> stream;
        std::string source;
        std::unique_ptr<asio::steady_timer> start; ///< null: at once
        bool admitted = false;
        bool was_ended = false; ///< at the last heartbeat, and is here all the same
    };
    mutable std::mutex sessions_mutex;
    std::map<std::uint64_t, Connection> connections; ///< changed on the io thread only
    std::uint64_t next_id = 1;
    bool beats = false; ///< the next heartbeat is on its way
    bool ends = false; ///< and then none is

    std::atomic<std::uint64_t> sent_bytes = 0, viewers = 0, scenes = 1; ///< counted for those who watch over the server
    std::atomic<steady_clock::time_point> last_beat = steady_clock::now();
    double earlier_rays = 0, earlier_busy_seconds = 0; ///< of loops before this one; under `sessions_mutex`

    std::shared_ptr<LoadedScene> loaded; ///< that the loop looks at; null: it is the caller's
    std::unique_ptr<SessionLoop>
        loop; ///< replaced on the io thread only, under `sessions_mutex`, without `loop_thread`
    std::thread loop_thread;

    Impl(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene, ServerOptions const& given,
         std::unique_ptr<Listener> bound)
        : listener(std::move(bound)), options(given), welcome(make_welcome(scene, clips)),
          clock(!given.paused, steady_clock::now()), control(control_rule(given)),
          memory(given.session_megabytes * 1'000'000),
          loop(make_loop(scene, std::move(clips), render_scene, given.loop)) {
        if (!options.tls_certificate.empty()) {
            tls = make_tls_server_context(options.tls_certificate, options.tls_key);
        }
        listener->listen();
    }

    std::unique_ptr<SessionLoop> make_loop(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene,
                                           LoopOptions const& loop_options) {
        SessionLoop::Events events{[this] { return open_sessions(); }, [this] { post_status(); }};
        return std::make_unique<SessionLoop>(scene, std::move(clips), render_scene, clock, loop_options,
                                             std::move(events));
    }

    void start_loop() {
        loop_thread = std::thread([serving = loop.get()] { serving->run(); });
    }

    void stop_loop() {
        if (loop_thread.joinable()) {
            loop->stop();
            loop_thread.join();
        }
    }

    void replace_scene(std::shared_ptr<LoadedScene> next) {
        if (ends) {
            return;
        }
        // All that may want for memory comes first: then either scene is served as a whole.
        LoopOptions loop_options = options.loop;
        loop_options.stream.exposure = next->exposure;
        Welcome next_welcome = make_welcome(next->scene, next->clips);
        auto next_loop = make_loop(next->scene, next->clips, next->render_scene, loop_options);
        SessionLoop::Sessions const sessions = open_sessions();
        stop_loop();
        for (auto const& session : sessions) {
            session->end("the scene is loaded again", true);
        }
        while (give_up_longest_parked()) {
        }
        welcome = std::move(next_welcome);
        {
            std::scoped_lock const lock(sessions_mutex);
            earlier_rays += loop->rays();
            earlier_busy_seconds += loop->busy_seconds();
            std::swap(loop, next_loop);
        }
        next_loop.reset(); // before the scene that it looks at
        ++scenes;
        loaded = std::move(next);
        start_loop();
    }

    SessionLoop::Sessions open_sessions() const {
        std::scoped_lock const lock(sessions_mutex);
        SessionLoop::Sessions open;
        for (auto const& [id, connection] : connections) {
            if (connection.session->is_open()) {
                open.push_back(connection.session);
            }
        }
        return open;
    }

    /// From any thread.
    void post_status() {
        try {
            asio::post(io, [this] { send_status(); });
        } catch (std::bad_alloc const&) { // the next heartbeat says the same
        }
    }

    /// Throws std::bad_alloc, and then nothing is left of the connection.
    void add_connection(tcp::socket socket) {
        boost::system::error_code error;
        auto const endpoint = socket.remote_endpoint(error);
        if (error) {
            return; // it is gone already
        }
        std::uint64_t const id = next_id++;
        try {
            add_connection(id, std::move(socket), endpoint);
        } catch (std::bad_alloc const&) {
            if (auto const found = connections.find(id); found != connections.end()) {
                found->second.stream->close(); // it may have begun to read
            }
            forget(id);
            throw;
        }
    }

    void add_connection(std::uint64_t id, tcp::socket socket, tcp::endpoint const& endpoint) {
        std::string const source = source_of(endpoint.address());
        if (auto const dropped = waiting.enter(id, source, std::generate_canonical<double, 32>(random))) {
            auto const session = connections.at(*dropped).session;
            session->start(); // it may have been delayed, and is told nothing before that
            session->end("too many connections at a time have not said yet who they are: try again", true);
        }
        ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_USER_TIMEOUT, &user_timeout_ms, sizeof user_timeout_ms);
        Connection connection;
        connection.source = source;
        connection.stream = tls ? tls_server_stream(std::move(socket), tls) : plain_stream(std::move(socket));
        connection.session = std::make_shared<Session>(id, connection.stream, session_events(id));
        auto const session = connection.session;
        auto const delay = guesses.delay(source, steady_clock::now());
        if (delay.count() > 0) {
            connection.start = std::make_unique<asio::steady_timer>(io, delay);
            connection.start->async_wait([session](boost::system::error_code aborted) {
                if (!aborted) {
                    session->start();
                }
            });
        }
        {
            std::scoped_lock const lock(sessions_mutex);
            connections[id] = std::move(connection);
        }
        if (delay.count() <= 0) {
            session->start();
        }
    }

    Session::Events session_events(std::uint64_t id) {
        Session::Events events;
        events.admit = [this, id](Hello const& hello) { return admit(id, hello); };
        events.clock_request = [this, id](ClockRequest const& request) {
            if (control.controls(id)) {
                set_clock(request);
            }
        };
        events.resize = [this, id](Viewport viewport, bool predicts) { return reserve(id, viewport, predicts); };
        events.changed = [this] { loop->wake(); };
        events.ended = [this, id](std::string const& reason) { end_session(id, reason); };
        events.sent = [this](std::size_t bytes) { sent_bytes += bytes; };
        return events;
    }

    /// Viewers that are away leave their memory to those that are here.
    std::optional<std::string> reserve(std::uint64_t id, Viewport viewport, bool predicts) {
        auto refusal = memory.reserve(id, viewport, predicts);
        while (refusal && give_up_longest_parked()) {
            refusal = memory.reserve(id, viewport, predicts);
        }
        return refusal;
    }

    /// False where nobody is away.
    bool give_up_longest_parked() {
        Tickets::Holder* const holder = tickets.longest_parked();
        if (holder == nullptr) {
            return false;
        }
        give_up(*holder);
        return true;
    }

    /// This viewer, which is away, does not come back, or has to begin anew.
    void give_up(Tickets::Holder const& holder) {
        std::shared_ptr<Session> const session = holder.session;
        tickets.erase(&holder);
        session->abandon();
        memory.release(session->id());
        loop->wake();
    }

    std::variant<Welcome, Failure> admit(std::uint64_t id, Hello const& hello) {
        Connection& connection = connections.at(id);
        if (hello.version != protocol_version) {
            return Failure{"this server speaks protocol version " + std::to_string(protocol_version) +
                           ", the viewer version " + std::to_string(hello.version) +
                           ": install the same release on both"};
        }
        bool const knows_control_token =
            !options.control_token.empty() && same_token(hello.token, options.control_token);
        if (!options.token.empty() && !knows_control_token && !same_token(hello.token, options.token)) {
            if (!hello.token.empty()) { // which would be no guess
                note_wrong_token(connection.source);
            }
            return Failure{"wrong or missing token: start the viewer with --token-file"};
        }
        Tickets::Holder* holder = hello.ticket ? tickets.find(hello.ticket) : nullptr;
        if (holder != nullptr && !holder->parked) { // what it says is newer than what is known of its connection
            auto const before = holder->session;
            before->cut();
            remove(before->id(), "it has come back by another connection");
            holder = tickets.find(hello.ticket);
        }
        if (open_sessions().size() >= options.max_sessions) {
            return Failure{"the server has its " + std::to_string(options.max_sessions) +
                               " viewers already: try later or raise --max-sessions",
                           true};
        }
        spdlog::info("viewer {} connects from {}", id, connection.session->peer());
        connection.admitted = true;
        ++viewers;
        waiting.leave(id);
        Welcome answer = welcome;
        answer.clock = clock.state(steady_clock::now());
        if (holder != nullptr && !resume(*holder, connection.session, hello, knows_control_token)) {
            give_up(*holder);
            holder = nullptr;
        }
        if (holder != nullptr) {
            answer.resumed = true;
            answer.let_go = connection.session->status().let_go;
        } else {
            tickets.issue({make_ticket(), connection.session, id, hello.codings, knows_control_token, std::nullopt});
            holder = tickets.of(*connection.session);
        }
        answer.ticket = holder->ticket;
        control.enter(id, holder->seat, knows_control_token);
        answer.controls = control.controls(id);
        return answer;
    }

    /// False where the viewer is another one by what it knows and reads, or lacks what is not kept any more.
    bool resume(Tickets::Holder& holder, std::shared_ptr<Session> const& session, Hello const& hello,
                bool knows_control_token) {
        auto const earlier = holder.session;
        if (holder.codings != hello.codings || holder.knows_control_token != knows_control_token ||
            !earlier->can_be_resumed(hello.last_batch)) {
            return false;
        }
        spdlog::info("viewer {} is viewer {}, who has come back", session->id(), earlier->id());
        memory.pass(earlier->id(), session->id());
        session->resume(earlier, hello.last_batch);
        holder.session = session;
        holder.parked.reset();
        return true;
    }

    void note_wrong_token(std::string const& source) {
        auto const now = steady_clock::now();
        guesses.note_wrong(source, now);
        if (auto const more = wrong_tokens.next(now)) {
            spdlog::warn("wrong token from {}{}", source, *more);
        }
    }

    void set_clock(ClockRequest const& request) {
        if (!clock_requests.add(request)) {
            return;
        }
        try {
            clock_timer.expires_at(clock_requests.due());
            clock_timer.async_wait([this](boost::system::error_code error) {
                if (!error) {
                    apply_clock_requests();
                }
            });
        } catch (std::bad_alloc const&) {
            apply_clock_requests(); // nobody would come for them later
        }
    }

    void apply_clock_requests() {
        auto const now = steady_clock::now();
        clock.apply(clock_requests.take(now), now);
        for (auto const& session : open_sessions()) {
            session->note_clock_change();
        }
        loop->wake();
        send_status();
    }

    void end_session(std::uint64_t id, std::string const& reason) {
        // Later: the session is still on the stack.
        asio::post(io, [this, id, reason] { remove(id, reason); });
        loop->wake();
    }

    void remove(std::uint64_t id, std::string const& reason) {
        auto const found = connections.find(id);
        if (found == connections.end()) {
            return; // two threads ended it at once
        }
        log_end(id, found->second, reason);
        auto const stream = found->second.stream;
        forget(id);
        while (tickets.parked_count() > options.max_sessions) {
            give_up_longest_parked();
        }
        farewells.add(stream);
        send_status(); // it may be another's turn to control
    }

    /// Gives back all that it had, but what a viewer goes on with that comes back. Takes no memory for that.
    void forget(std::uint64_t id) {
        waiting.leave(id);
        control.leave(id);
        park_or_release(id);
        std::scoped_lock const lock(sessions_mutex);
        connections.erase(id);
    }

    void park_or_release(std::uint64_t id) {
        auto const found = connections.find(id);
        Tickets::Holder* const holder = found == connections.end() ? nullptr : tickets.of(*found->second.session);
        if (holder != nullptr && holder->session->is_parked()) {
            holder->parked = steady_clock::now();
        } else if (holder != nullptr) {
            give_up(*holder);
        } else {
            memory.release(id);
        }
    }

    void give_up_who_stay_away() {
        while (auto const* const holder = tickets.overdue(steady_clock::now())) {
            give_up(*holder);
        }
    }

    void log_end(std::uint64_t id, Connection const& connection, std::string const& reason) {
        if (connection.admitted) {
            spdlog::info("viewer {} left: {}", id, reason);
        } else if (auto const more = turned_away.next(steady_clock::now())) {
            spdlog::info("a connection from {} ended before it was a viewer's: {}{}", connection.source, reason, *more);
        }
    }

    void send_status() {
        auto const sessions = open_sessions();
        for (auto const& session : sessions) {
            Status status = session->status();
            status.clock = clock.state(steady_clock::now());
            status.converged = status.converged && !(status.clock.playing && welcome.animation_duration > 0);
            status.samples_per_second = loop->samples_per_second();
            status.sessions = static_cast<std::uint32_t>(sessions.size());
            status.controls = control.controls(session->id());
            session->send(status);
        }
    }

    void drop_overdue_connections() {
        auto const now = steady_clock::now();
        std::vector<std::pair<std::shared_ptr<Session>, std::string>> overdue;
        for (auto const& [id, connection] : connections) {
            if (auto const reason = connection.session->overdue(now)) {
                overdue.emplace_back(connection.session, *reason);
            }
        }
        for (auto const& [session, reason] : overdue) {
            session->end(reason, true);
        }
    }

    /// Those that ended when there was no memory for all that belongs to it.
    void drop_remains() {
        std::vector<std::uint64_t> remains;
        for (auto& [id, connection] : connections) {
            if (connection.was_ended) {
                remains.push_back(id);
            }
            connection.was_ended = connection.session->has_ended();
        }
        for (std::uint64_t const id : remains) {
            connections.at(id).stream->close();
            remove(id, "no memory left");
        }
    }

    void drop_stuck_connections() {
        std::vector<std::shared_ptr<Session>> stuck;
        for (auto const& [id, connection] : connections) {
            if (connection.session->is_stuck()) {
                stuck.push_back(connection.session);
            }
        }
        for (auto const& session : stuck) {
            session->end("the server has no memory left", true);
        }
    }

    void beat() {
        if (ends) {
            return;
        }
        timer.expires_after(heartbeat);
        timer.async_wait([this](boost::system::error_code error) {
            beats = false;
            if (!error) {
                last_beat = steady_clock::now();
                drop_stuck_connections();
                drop_remains();
                drop_overdue_connections();
                give_up_who_stay_away();
                send_status();
                beat();
            }
        });
        beats = true;
    }

    /// Until everything is closed. Memory that is missing for something that is no session's own is missing for a
    /// moment, and what has not been done for that is done then.
    void run_io() {
        for (bool is_to_recover = false;;) {
            try {
                if (std::exchange(is_to_recover, false)) {
                    listener->accept_again();
                    if (!beats) {
                        beat();
                    }
                    drop_stuck_connections();
                }
                io.run();
                return;
            } catch (std::bad_alloc const&) {
                is_to_recover = true;
                if (auto const more = without_memory.next(steady_clock::now())) {
                    spdlog::warn("no memory left for a moment{}", *more);
                }
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            }
        }
    }

    ServerFigures figures() const {
        ServerFigures now;
        now.healthy = steady_clock::now() - last_beat.load() < healthy_pause;
        now.sessions = open_sessions().size();
        now.viewers = viewers;
        now.scenes = scenes;
        now.sent_bytes = sent_bytes;
        now.resident_bytes = resident_bytes();
        std::scoped_lock const lock(sessions_mutex);
        now.rays = earlier_rays + loop->rays();
        now.busy_seconds = earlier_busy_seconds + loop->busy_seconds();
        now.rays_per_second = loop->samples_per_second();
        return now;
    }

    void wait_for_signal(std::function<bool()> hang_up) {
        signals.async_wait([this, hang_up = std::move(hang_up)](boost::system::error_code error, int signal) {
            if (error) {
                return;
            }
            if (signal == SIGHUP && hang_up && hang_up()) {
                wait_for_signal(hang_up);
                return;
            }
            spdlog::info("ending on signal {}", signal);
            shut_down();
        });
    }

    void shut_down() {
        boost::system::error_code ignored;
        ends = true;
        listener->close();
        timer.cancel();
        clock_timer.cancel();
        signals.cancel(ignored);
        for (auto const& [id, connection] : connections) {
            connection.session->close("the server shuts down", true);
            if (connection.start) {
                connection.start->cancel();
            }
        }
    }
};

Server::Server(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene, ServerOptions const& options,
               std::unique_ptr<Listener> listener)
    : impl_(std::make_unique<Impl>(scene, std::move(clips), render_scene, options, std::move(listener))) {}

Server::Server(std::unique_ptr<LoadedScene> scene, ServerOptions const& options, std::unique_ptr<Listener> listener) {
    ServerOptions exposed = options;
    exposed.loop.stream.exposure = scene->exposure;
    impl_ = std::make_unique<Impl>(scene->scene, scene->clips, scene->render_scene, exposed, std::move(listener));
    impl_->loaded = std::move(scene);
}

Server::Server(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene, ServerOptions const& options)
    : Server(scene, std::move(clips), render_scene, options, std::make_unique<Listener>(options.bind, options.port)) {}

Server::~Server() = default;

std::uint16_t Server::port() const {
    return impl_->listener->endpoints().front().port();
}

std::vector<std::string> Server::addresses() const {
    std::vector<std::string> texts;
    for (auto const& endpoint : impl_->listener->endpoints()) {
        texts.push_back(text_of(endpoint));
    }
    return texts;
}

void Server::take_signals(std::function<bool()> hang_up) {
    impl_->signals.add(SIGINT);
    impl_->signals.add(SIGTERM);
    struct sigaction at_hang_up {};
    if (::sigaction(SIGHUP, nullptr, &at_hang_up) == 0 && at_hang_up.sa_handler != SIG_IGN) { // as nohup does
        impl_->signals.add(SIGHUP);
    }
    impl_->wait_for_signal(std::move(hang_up));
}

void Server::run() {
    impl_->listener->accept([this](tcp::socket socket) { impl_->add_connection(std::move(socket)); });
    impl_->beat();
    impl_->start_loop();
    try {
        impl_->run_io();
    } catch (...) {
        impl_->stop_loop();
        throw;
    }
    impl_->stop_loop();
}

void Server::replace_scene(std::shared_ptr<LoadedScene> next) {
    asio::post(impl_->io, [this, next = std::move(next)]() mutable { impl_->replace_scene(std::move(next)); });
}

ServerFigures Server::figures() const {
    return impl_->figures();
}

void Server::stop() {
    asio::post(impl_->io, [this] { impl_->shut_down(); });
}

} // namespace framelet
