// Those who come to a server for a while and behave badly. In: when, how, for how long. A resource: processes and
// sockets.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "tests/evaluation/soak/storm.h"

namespace framelet::bench {

class Stranger;

class Strangers {
public:
    /// Of the server at this port of 127.0.0.1.
    explicit Strangers(std::uint16_t port);
    ~Strangers();

    /// One comes; it goes `moment.seconds` after `now`. Throws boost::system::system_error where nobody listens.
    void add(StormMoment const& moment, double now);
    /// Those whose time is over go, and whoever is to be stopped amid it is.
    void pass_time(double now);
    void end_all();

private:
    std::uint16_t const port_;
    std::vector<std::unique_ptr<Stranger>> present_;
};

} // namespace framelet::bench
