#include "server/session/server.h"

#include <map>
#include <mutex>
#include <thread>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>

#include "common/error.h"
#include "protocol/stream_opening.h"
#include "protocol/token.h"
#include "server/scene/animation.h"
#include "server/session/clock_requests.h"
#include "server/session/session_memory.h"

namespace framelet {

namespace asio = boost::asio;
using asio::ip::tcp;
using std::chrono::steady_clock;

namespace {

constexpr std::chrono::seconds heartbeat{1};
constexpr std::chrono::seconds handshake_timeout{10};
/// Connections that may be amid their handshake at a time, beyond the open sessions.
constexpr std::size_t max_waiting_connections = 64;
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
    return welcome;
}

} // namespace

bool is_loopback(std::string const& bind) {
    boost::system::error_code error;
    auto const address = asio::ip::make_address(bind, error);
    return bind == "localhost" || (!error && address.is_loopback());
}

struct Server::Impl {
    asio::io_context io{1};
    tcp::acceptor acceptor{io};
    asio::steady_timer timer{io}, clock_timer{io};
    asio::signal_set signals{io};
    ServerOptions const options;
    std::shared_ptr<asio::ssl::context> tls;
    Welcome const welcome;
    SceneClock clock;
    ClockRequests clock_requests; ///< for the io thread only, as the next
    SessionMemory memory;

    struct Connection {
        std::shared_ptr<Session> session;
        steady_clock::time_point since;
    };
    mutable std::mutex sessions_mutex;
    std::map<std::uint64_t, Connection> connections; ///< changed on the io thread only
    std::uint64_t next_id = 1;

    SessionLoop loop;

    Impl(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene, ServerOptions const& given)
        : options(given), welcome(make_welcome(scene, clips)), clock(!given.paused, steady_clock::now()),
          memory(given.session_megabytes * 1'000'000),
          loop(scene, std::move(clips), render_scene, clock, given.loop,
               {[this] { return open_sessions(); }, [this] { asio::post(io, [this] { send_status(); }); }}) {
        if (!options.tls_certificate.empty()) {
            tls = make_tls_server_context(options.tls_certificate, options.tls_key);
        }
        listen();
    }

    void listen() {
        std::string const place = options.bind + ":" + std::to_string(options.port);
        boost::system::error_code error;
        tcp::resolver resolver(io);
        auto const found = resolver.resolve(options.bind, std::to_string(options.port),
                                            tcp::resolver::passive | tcp::resolver::numeric_service, error);
        if (error || found.empty()) {
            throw InputError("cannot listen on " + place + ": no such address: give --bind an address of this machine");
        }
        tcp::endpoint const endpoint = *found.begin();
        acceptor.open(endpoint.protocol(), error);
        if (!error) {
            acceptor.set_option(tcp::acceptor::reuse_address(true), error);
        }
        if (!error) {
            acceptor.bind(endpoint, error);
        }
        if (!error) {
            acceptor.listen(asio::socket_base::max_listen_connections, error);
        }
        if (error) {
            throw InputError("cannot listen on " + place + ": " + error.message() +
                             ": choose another --port or --bind");
        }
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

    void accept() {
        acceptor.async_accept([this](boost::system::error_code error, tcp::socket socket) {
            if (error == asio::error::operation_aborted) {
                return;
            }
            if (error) {
                spdlog::warn("cannot accept a connection: {}", error.message());
            } else {
                add_connection(std::move(socket));
            }
            accept();
        });
    }

    void add_connection(tcp::socket socket) {
        if (connections.size() >= options.max_sessions + max_waiting_connections) {
            return; // closes the socket: too many that have not said hello
        }
        ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_USER_TIMEOUT, &user_timeout_ms, sizeof user_timeout_ms);
        auto stream = tls ? tls_server_stream(std::move(socket), tls) : plain_stream(std::move(socket));
        std::uint64_t const id = next_id++;
        Session::Events events;
        events.admit = [this](Hello const& hello) { return admit(hello); };
        events.clock_request = [this](ClockRequest const& request) { set_clock(request); };
        events.resize = [this, id](Viewport viewport, bool predicts) { return memory.reserve(id, viewport, predicts); };
        events.changed = [this] { loop.wake(); };
        events.ended = [this, id](std::string const& reason) { end_session(id, reason); };
        auto session = std::make_shared<Session>(id, std::move(stream), std::move(events));
        spdlog::info("viewer {} connects from {}", id, session->peer());
        {
            std::scoped_lock const lock(sessions_mutex);
            connections[id] = {session, steady_clock::now()};
        }
        session->start();
    }

    std::variant<Welcome, Failure> admit(Hello const& hello) {
        if (hello.version != protocol_version) {
            return Failure{"this server speaks protocol version " + std::to_string(protocol_version) +
                           ", the viewer version " + std::to_string(hello.version) +
                           ": install the same release on both"};
        }
        if (!options.token.empty() && !same_token(hello.token, options.token)) {
            return Failure{"wrong or missing token: start the viewer with --token-file"};
        }
        if (open_sessions().size() >= options.max_sessions) {
            return Failure{"the server has its " + std::to_string(options.max_sessions) +
                           " viewers already: try later or raise --max-sessions"};
        }
        Welcome answer = welcome;
        answer.clock = clock.state(steady_clock::now());
        return answer;
    }

    void set_clock(ClockRequest const& request) {
        if (clock_requests.add(request)) {
            clock_timer.expires_at(clock_requests.due());
            clock_timer.async_wait([this](boost::system::error_code error) {
                if (!error) {
                    apply_clock_requests();
                }
            });
        }
    }

    void apply_clock_requests() {
        auto const now = steady_clock::now();
        clock.apply(clock_requests.take(now), now);
        for (auto const& session : open_sessions()) {
            session->note_clock_change();
        }
        loop.wake();
        send_status();
    }

    void end_session(std::uint64_t id, std::string const& reason) {
        spdlog::info("viewer {} left: {}", id, reason);
        // Later: the session is still on the stack.
        asio::post(io, [this, id] {
            std::scoped_lock const lock(sessions_mutex);
            connections.erase(id);
            memory.release(id);
        });
        loop.wake();
    }

    void send_status() {
        auto const sessions = open_sessions();
        for (auto const& session : sessions) {
            Status status = session->status();
            status.clock = clock.state(steady_clock::now());
            status.converged = status.converged && !(status.clock.playing && welcome.animation_duration > 0);
            status.samples_per_second = loop.samples_per_second();
            status.sessions = static_cast<std::uint32_t>(sessions.size());
            session->send(status);
        }
    }

    void drop_silent_connections() {
        auto const now = steady_clock::now();
        std::vector<std::pair<std::shared_ptr<Session>, std::string>> silent;
        {
            std::scoped_lock const lock(sessions_mutex);
            for (auto const& [id, connection] : connections) {
                if (connection.session->has_stopped_answering(now)) {
                    silent.emplace_back(connection.session, "the viewer stopped acknowledging");
                } else if (!connection.session->is_open() && now - connection.since > handshake_timeout) {
                    silent.emplace_back(connection.session, "no Hello within the time for it");
                }
            }
        }
        for (auto const& [session, reason] : silent) {
            session->end(reason);
        }
    }

    void beat() {
        timer.expires_after(heartbeat);
        timer.async_wait([this](boost::system::error_code error) {
            if (!error) {
                drop_silent_connections();
                send_status();
                beat();
            }
        });
    }

    void shut_down() {
        boost::system::error_code ignored;
        acceptor.close(ignored);
        timer.cancel();
        clock_timer.cancel();
        signals.cancel(ignored);
        std::scoped_lock const lock(sessions_mutex);
        for (auto const& [id, connection] : connections) {
            connection.session->close("the server shuts down");
        }
    }
};

Server::Server(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene, ServerOptions const& options)
    : impl_(std::make_unique<Impl>(scene, std::move(clips), render_scene, options)) {}

Server::~Server() = default;

std::uint16_t Server::port() const {
    return impl_->acceptor.local_endpoint().port();
}

std::string Server::address() const {
    auto const endpoint = impl_->acceptor.local_endpoint();
    std::string const host = endpoint.address().to_string();
    return (endpoint.address().is_v6() ? "[" + host + "]" : host) + ":" + std::to_string(endpoint.port());
}

void Server::run(bool handle_signals) {
    if (handle_signals) {
        impl_->signals.add(SIGINT);
        impl_->signals.add(SIGTERM);
        impl_->signals.async_wait([this](boost::system::error_code error, int signal) {
            if (!error) {
                spdlog::info("ending on signal {}", signal);
                impl_->shut_down();
            }
        });
    }
    impl_->accept();
    impl_->beat();
    std::jthread const loop([this] { impl_->loop.run(); });
    try {
        impl_->io.run(); // returns when everything is closed
    } catch (...) {
        impl_->loop.stop();
        throw;
    }
    impl_->loop.stop();
}

void Server::stop() {
    asio::post(impl_->io, [this] { impl_->shut_down(); });
}

} // namespace framelet
