// Strangers: those who come to a server for a while and behave badly. In: when, how, for how long. A resource:
// processes and sockets.
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
    /// They come to the server at this port of 127.0.0.1.
    explicit Strangers(std::uint16_t port);
    ~Strangers();

    /// Lets a stranger come; it goes `moment.seconds` after `now`. Throws boost::system::system_error where nobody
    /// listens.
    void add(StormMoment const& moment, double now);
    /// Ends the strangers whose time is over, and stops those that are to be stopped half-way.
    void pass_time(double now);
    void end_all();

private:
    std::uint16_t const port_;
    std::vector<std::unique_ptr<Stranger>> present_;
};

} // namespace framelet::bench
