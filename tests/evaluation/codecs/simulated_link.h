// Simulates a link on the virtual clock: rate, delay, jitter, loss, stalls. Reliable and in order, as TCP is. A value:
// the same messages at the same times arrive at the same times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <vector>

namespace framelet::bench {

/// A time in which the link carries nothing: `seconds` long, from `begin` on.
struct Stall {
    double begin = 0, seconds = 0;
};

/// A change of the link's rate, from `begin` on.
struct RateStep {
    double begin = 0, bits_per_second = 0;
};

struct LinkParameters {
    double bits_per_second = 0; ///< 0: unlimited
    double delay_seconds = 0; ///< seconds, one way
    double jitter_seconds = 0; ///< further delay, uniform from 0 to this
    /// Share of packets of 1500 bytes that are lost, [0, 1): such a message, and what is behind it, comes one round
    /// trip later. The rate stays, as with a congestion control that does not take loss for a full queue.
    double loss = 0;
    std::vector<Stall> stalls{}; ///< in order of time, disjoint
    std::vector<RateStep> rate_steps{}; ///< in order of time
    std::uint64_t seed = 1;
};

/// Reads a link from a JSON file: {"megabits": 20, "delay_ms": 30, "jitter_ms": 10, "loss": 0.01, "steps": [[seconds,
/// megabits], ...], "stalls": [[begin, seconds], ...]}; what is left out is none. Throws InputError.
LinkParameters read_link(std::filesystem::path const& file);

class SimulatedLink {
public:
    /// Throws InputError for a rate, delay, jitter or loss below 0, for a loss of 1 and more, for times that are not
    /// finite, and for stalls or steps that are not in order.
    explicit SimulatedLink(LinkParameters parameters);

    struct Delivery {
        double begun = 0; ///< when the first byte left the sender
        double departed = 0; ///< when the last byte left the sender
        double arrived = 0; ///< when the last byte is at the receiver; never before an earlier message
    };

    /// Sends a message. Times of calls must not decrease.
    Delivery send(double now, std::size_t bytes);

    /// Bytes that were sent and have not left yet. `now`: not before the last call of `send`.
    double backlog_bytes(double now) const;
    /// Rate in force at `time`, bits a second, stalls apart; 0: unlimited.
    double rate_at(double time) const;

private:
    struct Waiting {
        double started = 0, departed = 0; ///< times at which the first and the last byte leave
        double bytes = 0;
    };

    /// The first moment after `time` at which the rate changes or a stall begins or ends.
    double next_change(double time) const;
    bool stalled_at(double time) const;
    /// Bits that a link that is always busy sends between two times of limited rate.
    double carried_bits(double from, double to) const;

    LinkParameters parameters_;
    double free_ = -1e300; ///< time at which the last byte sent so far has left
    double last_arrival_ = -1e300;
    std::deque<Waiting> waiting_; ///< messages that had not left by the last call of `send`
    std::uint64_t messages_ = 0;
};

} // namespace framelet::bench
