// Emulates a link between real processes: a TCP proxy on loopback that lets bytes through when the simulated link
// would, on the wall clock. In: the port of a server, a link. Out: the port that a client connects to instead.
#pragma once

#include <cstdint>
#include <memory>

#include "tests/evaluation/codecs/simulated_link.h"

namespace framelet::bench {

/// The whole link applies from the server to the client, its delay and jitter alone from the client to the server. All
/// connections share it. Bytes pass in slices of at most 2 ms (128 bytes at least). A connection reads ahead of its
/// receiver by what is on its way and a queue of 100 ms (64 KiB at least), or by 8 MiB on an unlimited link, and then
/// leaves the rest in the sender's socket, as a router does to TCP. A close passes through behind the bytes before it.
class LinkEmulator {
public:
    /// Listens on a free port of 127.0.0.1, forwards to `target_port` there. Stalls and rate steps count from now.
    /// Throws InputError for parameters that no link has, ConnectionError where it cannot listen.
    LinkEmulator(std::uint16_t target_port, LinkParameters const& link);
    /// Ends every connection.
    ~LinkEmulator();

    std::uint16_t port() const;
    /// Ends every connection, amid whatever is on its way; later connections are let through. May be called from any
    /// thread.
    void cut();

private:
    struct Proxy;
    std::unique_ptr<Proxy> proxy_;
};

} // namespace framelet::bench
