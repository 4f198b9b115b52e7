// The server: accepts viewers, keeps their sessions, the shared clock and the loop. A resource; owns sockets and
// threads.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/connection/server_address.h"
#include "server/session/figures/server_figures.h"
#include "server/session/limits/networks.h"
#include "server/session/loop/session_loop.h"

namespace framelet {

struct WebPage;

class Listener;
struct LoadedScene;

struct ServerOptions {
    std::string bind = "127.0.0.1"; ///< address, or a name: all that it stands for
    std::uint16_t port = 7070; ///< 0: any free one
    std::string token; ///< what a viewer has to say; empty: nothing
    std::string control_token; ///< who says it is let in as well, and may set the scene's clock; empty: the first may
    bool shared_control = false; ///< every viewer may set the scene's clock
    std::string tls_certificate; ///< PEM file; empty: no TLS
    std::string tls_key; ///< PEM file
    std::shared_ptr<WebPage const> web; ///< the page for browsers; null: browsers are no viewers
    std::size_t max_sessions = 8;
    std::size_t session_megabytes = 4096; ///< what the pictures of all viewers may take together
    bool paused = false; ///< the scene clock stands at 0 at first
    std::optional<ConnectionOptions> clock_from; ///< the server whose clock the scene's follows
    Networks proxies; ///< who connects from there says for whom, by a header of [PROXY protocol]
    std::chrono::seconds drain{0}; ///< after SIGTERM it serves on for so long, while nobody is sent to it any more
    LoopOptions loop;
};

class Server {
public:
    /// Listens at what is bound already: viewers can connect from now on (they are answered once `run` runs). Throws
    /// InputError where the certificate is of no use, or another program listens there meanwhile. `scene` must
    /// outlive the server.
    Server(PosedScene& scene, ServerOptions const& options, std::unique_ptr<Listener> listener);
    /// Serves a scene of its own, with its exposure, which another one can replace.
    Server(std::unique_ptr<LoadedScene> scene, ServerOptions const& options, std::unique_ptr<Listener> listener);
    /// Binds the address by itself. Throws InputError where it cannot be had.
    Server(PosedScene& scene, ServerOptions const& options);
    ~Server();

    /// Addresses that it listens on, with the real port, which is the same for all.
    std::vector<std::string> addresses() const;
    std::uint16_t port() const;

    /// From now on SIGINT, SIGTERM and SIGHUP (which whoever started the program may have told it to ignore) end `run`,
    /// those too that come before it. After SIGHUP it goes on where `hang_up`, called on its thread, says so.
    void take_signals(std::function<bool()> hang_up = {});
    /// Serves until `stop` or a signal. The calling thread does the network, one other the loop.
    void run();
    /// Serves this scene instead of the one before. All viewers are told to connect again, which those that look at a
    /// scene for longer do by themselves; the scene's clock goes on. May be called from any thread.
    void replace_scene(std::shared_ptr<LoadedScene> next);
    /// Ends `run`. May be called from any thread.
    void stop();
    /// Figures of what has been going on. May be called from any thread.
    ServerFigures figures() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// True for addresses that only this machine can reach (127.0.0.0/8, ::1, localhost).
bool is_loopback(std::string const& bind);

} // namespace framelet
