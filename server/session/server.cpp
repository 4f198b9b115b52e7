#include "server/session/server.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <exception>
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

#include "common/counted.h"
#include "protocol/stream/handshake_thread.h"
#include "protocol/stream/stream_opening.h"
#include "protocol/stream/tls.h"
#include "server/session/admission.h"
#include "server/session/clock/served_clock.h"
#include "server/session/connection_table.h"
#include "server/session/figures/busy_share.h"
#include "server/session/limits/farewells.h"
#include "server/session/limits/log_limit.h"
#include "server/session/limits/source.h"
#include "server/session/limits/waiting_room.h"
#include "server/session/listener.h"
#include "server/session/loaded_scene.h"
#include "server/session/loop/contained.h"
#include "server/session/loop/loop_thread.h"
#include "server/session/proxy_hall.h"
#include "server/session/welcome.h"
#include "server/workers/worker_pool.h"

namespace framelet {

namespace asio = boost::asio;
using asio::ip::tcp;
using std::chrono::steady_clock;

namespace {

constexpr std::chrono::seconds heartbeat{1};
/// Longest time without a heartbeat when all is well: a scene that is replaced holds it up for a moment.
constexpr std::chrono::seconds healthy_pause{10};
/// How long after a viewer has left the others are told, of all that leave meanwhile at once.
constexpr std::chrono::milliseconds leaving_told_after{100};
/// Most lines of viewers that have come, and that have gone, in an interval of the log.
constexpr std::size_t viewer_lines = 20;
/// A connection whose bytes nobody confirms for so long is dropped by the kernel, milliseconds.
constexpr unsigned user_timeout_ms = 15000;
/// Servers that follow this one's clock, and those of them from one source.
constexpr std::ptrdiff_t most_followers = 64, most_followers_of_source = 16;
constexpr std::ptrdiff_t most_workers = 1024;
constexpr std::size_t most_threads = 1024; ///< of each

/// What a picture at rest takes a pixel for its light.
std::size_t light_bytes(PosedScene const& scene) {
    return scene.path_light() != nullptr ? PathSums::bytes_per_pixel : 0;
}

} // namespace

bool is_loopback(std::string const& bind) {
    boost::system::error_code error;
    auto const address = asio::ip::make_address(bind, error);
    return bind == "localhost" || (!error && address.is_loopback());
}

struct Server::Impl {
    std::optional<HandshakeThread> handshakes; ///< goes after the io_context; nothing: there is no TLS
    std::unique_ptr<Listener> const listener;
    asio::io_context& io = listener->io;
    asio::steady_timer timer{io}, leaving_timer{io}, drain_timer{io};
    asio::signal_set signals{io};
    ServerOptions const options;
    std::shared_ptr<asio::ssl::context> tls;
    Welcome welcome;
    ServedClock clock; ///< for the io thread only, as all that follows unless it says otherwise
    Admission admission;
    WaitingRoom waiting;
    ProxyHall proxies;
    LogLimit turned_away, failures; ///< of what the log says of such connections, and of what fails for a moment
    LogLimit come{viewer_lines}, gone{viewer_lines}; ///< of viewers
    std::minstd_rand random{std::random_device{}()};
    Farewells farewells;

    ConnectionTable connections; ///< its open sessions may be asked for on any thread
    std::uint64_t next_id = 1;
    bool beats = false; ///< the next heartbeat is on its way
    bool tells_of_leaving = false; ///< a status that says who has left is on its way
    bool ends = false; ///< the server ends: no heartbeat follows

    std::atomic<std::uint64_t> sent_bytes = 0, viewers = 0, scenes = 1; ///< counted for those who watch over the server
    std::atomic<float> busy = 0; ///< as viewers are told
    std::atomic<bool> drains = false; ///< it serves those who are here, and ends then
    std::atomic<steady_clock::time_point> last_beat = steady_clock::now();
    BusyShare busy_share;

    WorkerPool workers; ///< goes after the loop
    std::uint64_t light; ///< `PosedScene::light_identity` of the scene
    std::shared_ptr<LoadedScene> loaded; ///< the scene that the loop looks at; null: it is the caller's
    LoopThread loop; ///< replaced on the io thread only; its figures may be asked for on any thread

    Impl(PosedScene& scene, Welcome told, ServerOptions const& given, std::unique_ptr<Listener> bound)
        : listener(std::move(bound)), options(given), welcome(std::move(told)),
          clock(
              io, !given.paused, [this] { tell_of_clock(); }, [this] { send_status(); }),
          admission({given.token, given.control_token, given.shared_control, given.session_megabytes * 1'000'000,
                     light_bytes(scene)},
                    [this] { loop.wake(); }),
          proxies(given.proxies), light(scene.light_identity()), loop(make_loop(scene, given.loop)) {
        if (!options.tls_certificate.empty()) {
            tls = make_tls_server_context(options.tls_certificate, options.tls_key);
            handshakes.emplace();
        }
        listener->listen();
    }

    ~Impl() {
        if (handshakes) {
            handshakes->stop();
        }
    }

    std::unique_ptr<SessionLoop> make_loop(PosedScene& scene, LoopOptions loop_options) {
        loop_options.stream.workers = &workers;
        SessionLoop::Events events{[this] { return connections.open_sessions(); }, [this] { post_status(); }};
        return std::make_unique<SessionLoop>(scene, clock.scene(), std::move(loop_options), std::move(events));
    }

    /// True where no viewer is here, or away for a moment.
    bool is_empty() const { return connections.open_sessions().empty() && !admission.expects_somebody(); }

    void replace_scene(std::shared_ptr<LoadedScene> next) {
        if (ends || drains) {
            return;
        }
        // All that may want for memory comes first: then either scene is served as a whole.
        LoopOptions loop_options = options.loop;
        loop_options.stream.exposure = next->exposure;
        Welcome next_welcome = next->welcome;
        auto next_loop = make_loop(next->posed, loop_options);
        SessionLoop::Sessions const sessions = connections.open_sessions(), others = connections.other_sessions();
        loop.stop();
        for (auto const& session : sessions) {
            try {
                session->end("the scene is loaded again", true);
            } catch (std::bad_alloc const&) {
                end_in_need(*session, true);
            }
        }
        for (auto const& session : others) {
            try {
                if (session->is_worker()) { // whose scene is the one before
                    session->end("the scene is loaded again", true);
                }
            } catch (std::bad_alloc const&) {
                end_in_need(*session, true);
            }
        }
        admission.forget_viewers(light_bytes(next->posed));
        light = next->posed.light_identity();
        welcome = std::move(next_welcome);
        loop.replace(std::move(next_loop)); // the one before goes before the scene that it looks at
        ++scenes;
        loaded = std::move(next);
        loop.start();
    }

    /// Has the status sent. May be called from any thread.
    void post_status() {
        try {
            asio::post(io, [this] { send_status(); });
        } catch (std::exception const&) { // the next heartbeat says the same
        }
    }

    void accept(tcp::socket socket) {
        proxies.take(
            std::move(socket),
            [this](tcp::socket from, asio::ip::address const& address, std::string const& peer) {
                add_connection(std::move(from), source_of(address), peer);
            },
            [this](std::string const& reason) {
                if (auto const more = turned_away.next(steady_clock::now())) {
                    spdlog::warn("{}{}", reason, *more);
                }
            });
    }

    /// Adds a connection. Where it throws, mostly for want of memory, nothing is left of the connection.
    void add_connection(tcp::socket socket, std::string const& source, std::string const& peer) {
        std::uint64_t const id = next_id++;
        try {
            add_connection(id, std::move(socket), source, peer);
        } catch (...) {
            if (Connection* const found = connections.find(id)) {
                found->stream->close(); // it may have begun to read
            }
            forget(id);
            throw;
        }
    }

    void add_connection(std::uint64_t id, tcp::socket socket, std::string const& source, std::string const& peer) {
        if (auto const dropped = waiting.enter(id, source, std::generate_canonical<double, 32>(random))) {
            auto const session = connections.find(*dropped)->session;
            session->start(); // it may have been delayed, and is told nothing before that
            session->end("too many connections at a time have not said yet who they are: try again", true);
        }
        ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_USER_TIMEOUT, &user_timeout_ms, sizeof user_timeout_ms);
        Connection connection;
        connection.source = source;
        connection.stream = tls ? tls_server_stream(std::move(socket), tls, handshakes->executor(), options.web)
                                : plain_stream(std::move(socket), options.web);
        connection.peer = peer.empty() ? connection.stream->peer() : peer;
        connection.session = std::make_shared<Session>(id, connection.stream, session_events(id));
        auto const session = connection.session;
        auto const delay = admission.delay(source, steady_clock::now());
        if (delay.count() > 0) {
            connection.start = std::make_unique<asio::steady_timer>(io, delay);
            connection.start->async_wait([session](boost::system::error_code aborted) {
                if (!aborted) {
                    session->start();
                }
            });
        }
        connections.add(id, std::move(connection));
        if (delay.count() <= 0) {
            session->start();
        }
    }

    Session::Events session_events(std::uint64_t id) {
        Session::Events events;
        events.admit = [this, id](Hello const& hello) { return admit(id, hello); };
        events.clock_request = [this, id](ClockRequest const& request) {
            if (controls(id)) {
                clock.request(request);
            }
        };
        events.resize = [this, id](Viewport viewport, bool predicts) {
            return admission.reserve(id, viewport, predicts);
        };
        events.changed = [this] { loop.wake(); };
        events.ended = [this, id](std::string const& reason) { end_session(id, reason); };
        events.path_answer = [this, id](PathAnswer answer) { workers.answer(id, std::move(answer)); };
        events.sent = [this](std::size_t bytes) { sent_bytes += bytes; };
        return events;
    }

    std::variant<Welcome, Failure> admit(std::uint64_t id, Hello const& hello) {
        Connection& connection = *connections.find(id);
        auto const now = steady_clock::now();
        if (auto const refusal = admission.refusal(hello, connection.source, now)) {
            return *refusal;
        }
        if (auto const before = admission.session_left_behind(hello)) {
            // What the viewer says is newer than what is known of its connection.
            before->cut();
            remove(before->id(), "it has come back by another connection");
        }
        if (hello.work) {
            return admit_worker(id, hello);
        }
        if (hello.codings == coding::none) {
            return admit_follower(id, hello);
        }
        if (connections.open_sessions().size() >= options.max_sessions) {
            return Failure{"the server has its " + std::to_string(options.max_sessions) +
                               " viewers already: try later or raise --max-sessions",
                           true};
        }
        connection.admitted = true;
        connection.session->set_number(++viewers);
        if (auto const more = come.next(now)) {
            spdlog::info("viewer {} connects from {}{}", connection.session->number(), connection.peer, *more);
        }
        waiting.leave(id);
        Welcome answer = welcome;
        answer.clock = clock.scene().state(now);
        admission.seat(connection.session, hello, answer);
        answer.controls = controls(id);
        return answer;
    }

    /// How many workers there are already, or others who have no pictures; `source`: of one, unless it is empty.
    std::ptrdiff_t count_others(bool are_workers, std::string const& source = {}) const {
        return std::ranges::count_if(connections.all(), [&](auto const& other) {
            Session const& session = *other.second.session;
            return session.is_open() && !session.has_pictures() && session.is_worker() == are_workers &&
                   (source.empty() || other.second.source == source);
        });
    }

    /// Lets in who traces paths for this server.
    std::variant<Welcome, Failure> admit_worker(std::uint64_t id, Hello const& hello) {
        WorkOffer const& offer = *hello.work;
        if (!admission.may_work(hello)) {
            return Failure{"a worker has to know the control token of this server"};
        }
        if (light == 0) {
            return Failure{"there is no work: the light of the scene is direct here, and quickly found"};
        }
        if (offer.scene != welcome.scene_identity || offer.light != light) {
            return Failure{"the worker would find other light: start it with the same scene, the same environment and "
                           "sizes of lights, from the same build and on the same kind of processor"};
        }
        if (count_others(true) >= most_workers) {
            return Failure{"the server has as many workers as it can have", true};
        }
        Connection const& connection = *connections.find(id);
        waiting.leave(id);
        auto const session = connection.session;
        WorkerPool::Worker worker{std::clamp<std::size_t>(offer.threads, 1, most_threads),
                                  [session](PathOrder const& order) { session->send(order); },
                                  [session](std::string const& reason) { session->end(reason); }};
        if (auto const more = come.next(steady_clock::now())) {
            spdlog::info("a worker of {} joins from {}{}", counted(worker.threads, "thread"), connection.peer, *more);
        }
        asio::post(io, [this, id, worker = std::move(worker)]() mutable { // once it has been welcomed
            if (connections.find(id) != nullptr) {
                workers.join(id, std::move(worker));
            }
        });
        Welcome answer = welcome;
        answer.clock = clock.scene().state(steady_clock::now());
        answer.controls = false;
        return answer;
    }

    /// Lets in a server that follows the clock.
    std::variant<Welcome, Failure> admit_follower(std::uint64_t id, Hello const& hello) {
        Connection const& connection = *connections.find(id);
        if (count_others(false, connection.source) >= most_followers_of_source ||
            count_others(false) >= most_followers) {
            return Failure{"too many servers follow this clock already", true};
        }
        waiting.leave(id);
        if (auto const more = come.next(steady_clock::now())) {
            spdlog::info("a server follows the clock, from {}{}", connection.peer, *more);
        }
        Welcome answer = welcome;
        answer.clock = clock.scene().state(steady_clock::now());
        admission.seat(connection.session, hello, answer);
        answer.controls = controls(id);
        return answer;
    }

    bool controls(std::uint64_t id) const { return admission.controls(id) && clock.takes_requests(); }

    void tell_of_clock() {
        for (auto const& session : connections.open_sessions()) {
            session->note_clock_change();
        }
        loop.wake();
        send_status();
    }

    void end_session(std::uint64_t id, std::string const& reason) {
        // Later: the session is still on the stack.
        asio::post(io, [this, id, reason] { remove(id, reason); });
        loop.wake();
    }

    void remove(std::uint64_t id, std::string const& reason) {
        Connection const* const found = connections.find(id);
        if (found == nullptr) {
            return; // two threads ended it at once
        }
        log_end(*found, reason);
        auto const stream = found->stream;
        bool const was_viewer = found->admitted;
        forget(id);
        admission.keep_parked(options.max_sessions);
        farewells.add(stream);
        if (was_viewer) {
            tell_of_leaving();
        }
    }

    /// Has the status sent, since it may be another's turn to control; not for each that leaves, who may be many.
    void tell_of_leaving() {
        if (tells_of_leaving) {
            return;
        }
        leaving_timer.expires_after(leaving_told_after);
        leaving_timer.async_wait([this](boost::system::error_code error) {
            tells_of_leaving = false;
            if (!error) {
                send_status();
            }
        });
        tells_of_leaving = true;
    }

    /// Forgets a connection. Needs no memory to do so.
    void forget(std::uint64_t id) {
        waiting.leave(id);
        workers.leave(id);
        Connection const* const found = connections.find(id);
        admission.leave(id, found == nullptr ? nullptr : found->session.get());
        connections.erase(id);
    }

    void log_end(Connection const& connection, std::string const& reason) {
        auto const now = steady_clock::now();
        if (connection.admitted) {
            if (auto const more = gone.next(now)) {
                spdlog::info("viewer {} left: {}{}", connection.session->number(), reason, *more);
            }
        } else if (!connection.session->has_pictures()) {
            if (auto const more = gone.next(now)) {
                spdlog::info("{}, from {}: {}{}",
                             connection.session->is_worker() ? "a worker has left"
                                                             : "a server does not follow the clock any more",
                             connection.peer, reason, *more);
            }
        } else if (connection.stream->asks_for_files()) {
            return; // a browser may keep such a connection open as long as it is let
        } else if (auto const more = turned_away.next(now)) {
            spdlog::info("a connection from {} ended before it was a viewer's: {}{}", connection.source, reason, *more);
        }
    }

    void send_status() {
        auto const sessions = connections.open_sessions();
        busy = busy_share.update(loop.busy_seconds(), steady_clock::now());
        for (auto const& session : sessions) {
            Status status = session->status();
            status.clock = clock.scene().state(steady_clock::now());
            status.converged = status.converged && !(status.clock.playing && welcome.animation_duration > 0);
            status.samples_per_second = loop.samples_per_second();
            status.sessions = static_cast<std::uint32_t>(sessions.size());
            status.controls = controls(session->id());
            status.busy = busy;
            session->send(status);
        }
        for (auto const& other : connections.other_sessions()) {
            Status status;
            status.clock = clock.scene().state(steady_clock::now());
            status.controls = controls(other->id());
            other->send(status);
        }
    }

    void drop_overdue_connections() {
        for (auto const& [session, reason] : connections.overdue(steady_clock::now())) {
            // A browser that keeps a connection for later would take a Failure for its answer.
            session->end(reason, true, session->has_spoken());
        }
    }

    void drop_remains() {
        for (std::uint64_t const id : connections.take_remains()) {
            connections.find(id)->stream->close();
            remove(id, "no memory left");
        }
    }

    void drop_stuck_connections() {
        for (auto const& session : connections.stuck()) {
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
                admission.give_up_who_stay_away(steady_clock::now());
                send_status();
                if (drains && is_empty()) {
                    shut_down();
                }
                beat();
            }
        });
        beats = true;
    }

    void tell_failure(std::exception const& error) noexcept {
        try {
            if (auto const more = failures.next(steady_clock::now())) {
                bool const memory = dynamic_cast<std::bad_alloc const*>(&error) != nullptr;
                spdlog::warn("{}{}", memory ? "no memory left for a moment" : error.what(), *more);
            }
        } catch (std::exception const&) { // memory is missing for the words, too
        }
    }

    /// Runs until everything is closed. What fails here is no session's own. Memory is missing for a moment, and what
    /// has not been done for that is done then.
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
            } catch (std::exception const& error) {
                is_to_recover = true;
                tell_failure(error);
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            }
        }
    }

    ServerFigures figures() const {
        ServerFigures now;
        now.healthy = steady_clock::now() - last_beat.load() < healthy_pause;
        now.sessions = connections.open_sessions().size();
        now.ready = now.healthy && !drains && now.sessions < options.max_sessions;
        now.busy = static_cast<double>(busy.load());
        now.viewers = viewers;
        now.scenes = scenes;
        now.sent_bytes = sent_bytes;
        now.workers = workers.workers();
        now.worker_paths = workers.paths();
        now.resident_bytes = resident_bytes();
        loop.add_figures(now);
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
            if (signal == SIGTERM && options.drain.count() > 0 && !drains && !is_empty()) {
                drain();
                wait_for_signal(hang_up);
                return;
            }
            spdlog::info("ending on signal {}", signal);
            shut_down();
        });
    }

    /// Says that it is not ready any more, and ends when its viewers have left, or after a while.
    void drain() {
        spdlog::info("ending in {} s, or when all viewers have left", options.drain.count());
        drains = true;
        drain_timer.expires_after(options.drain);
        drain_timer.async_wait([this](boost::system::error_code error) {
            if (!error) {
                shut_down();
            }
        });
    }

    void shut_down() {
        boost::system::error_code ignored;
        ends = true;
        listener->close();
        timer.cancel();
        clock.stop();
        leaving_timer.cancel();
        drain_timer.cancel();
        proxies.close();
        signals.cancel(ignored);
        for (auto const& [id, connection] : connections.all()) {
            connection.session->close("the server shuts down", true);
            if (connection.start) {
                connection.start->cancel();
            }
        }
    }
};

Server::Server(PosedScene& scene, ServerOptions const& options, std::unique_ptr<Listener> listener)
    : impl_(std::make_unique<Impl>(scene, make_welcome(scene.scene(), scene.clips()), options, std::move(listener))) {}

Server::Server(std::unique_ptr<LoadedScene> scene, ServerOptions const& options, std::unique_ptr<Listener> listener) {
    ServerOptions exposed = options;
    exposed.loop.stream.exposure = scene->exposure;
    impl_ = std::make_unique<Impl>(scene->posed, scene->welcome, exposed, std::move(listener));
    impl_->loaded = std::move(scene);
}

Server::Server(PosedScene& scene, ServerOptions const& options)
    : Server(scene, options, std::make_unique<Listener>(options.bind, options.port)) {}

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
    impl_->listener->accept([this](tcp::socket socket) { impl_->accept(std::move(socket)); });
    impl_->beat();
    if (impl_->options.clock_from) {
        impl_->clock.follow(*impl_->options.clock_from);
    }
    impl_->loop.start();
    try {
        impl_->run_io();
    } catch (...) {
        impl_->loop.stop();
        throw;
    }
    impl_->loop.stop();
    impl_->clock.unfollow(); // who is here has been told by now
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
