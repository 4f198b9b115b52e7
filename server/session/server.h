// The server: accepts viewers, keeps their sessions, the shared clock and the loop. A resource; owns sockets and
// threads.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "server/render/render_scene.h"
#include "server/scene/scene.h"
#include "server/session/session_loop.h"

namespace framelet {

struct ServerOptions {
    std::string bind = "127.0.0.1";
    std::uint16_t port = 7070; ///< 0: any free one
    std::string token; ///< what a viewer has to say; empty: nothing
    std::string tls_certificate; ///< PEM file; empty: no TLS
    std::string tls_key; ///< PEM file
    std::size_t max_sessions = 8;
    std::size_t session_megabytes = 4096; ///< what the pictures of all viewers may take together
    bool paused = false; ///< the scene clock stands at 0 at first
    LoopOptions loop;
};

class Server {
public:
    /// Binds and listens: viewers can connect from now on (they are answered once `run` runs). Throws InputError where
    /// the address cannot be had. `scene` and `render_scene` must outlive the server.
    Server(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene, ServerOptions const& options);
    ~Server();

    /// Address that it listens on, with the real port.
    std::string address() const;
    std::uint16_t port() const;

    /// Serves until `stop` or, when asked for, SIGINT or SIGTERM. The calling thread does the network, one other the
    /// loop.
    void run(bool handle_signals);
    /// From any thread.
    void stop();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// True for addresses that only this machine can reach (127.0.0.0/8, ::1, localhost).
bool is_loopback(std::string const& bind);

} // namespace framelet
