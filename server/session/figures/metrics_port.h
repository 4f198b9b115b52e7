// The port at which Prometheus and health checks ask, by HTTP. A resource with a thread of its own, so that it answers
// while the server cannot. In: figures when they are asked for. Out: /metrics, /health and
// /ready.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "server/session/figures/server_figures.h"

namespace framelet {

class MetricsPort {
public:
    /// Most connections at a time; another one costs the oldest its place.
    static constexpr std::size_t most_connections = 16;

    /// Binds. Throws InputError where the address cannot be had.
    MetricsPort(std::string const& bind, std::uint16_t port);
    ~MetricsPort();

    /// Answers from now on. `figures` is called on a thread of this object, and must be callable until its end.
    void start(std::function<ServerFigures()> figures);
    /// Address that it listens on, with the real port.
    std::string address() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace framelet
