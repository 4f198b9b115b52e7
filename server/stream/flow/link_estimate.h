// What the way to a viewer carries, learnt from what was sent and acknowledged. In: bytes and times; out: the rate of
// the link, how long a batch takes, and whether another one may be sent now.
//
// The window is delay-based, as that of Vegas (Brakmo, Peterson 1995) and BBR (Cardwell et al. 2016): what is in flight
// is bounded to the rate of delivery times the shortest round trip seen lately and a small queue, whatever TCP would
// let through. A queue counts when it stands for a while (CoDel, RFC 8289), so that jitter is none.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

namespace framelet {

/// A shorter round trip says nothing of a link, seconds: there is hardly one.
inline constexpr double least_round_trip = 0.002;

struct LinkState {
    /// Infinite: it has not been felt yet. At first, while the window is still being found, what that allows.
    double bytes_per_second = std::numeric_limits<double>::infinity();
    double bytes_per_sample = 0; ///< of what was sent lately, or will be first, with everything that goes with it
    double delivery_seconds = 0; ///< from sending until a batch has arrived, lately
    double base_seconds = 0; ///< the shortest round trip lately
    double batch_bytes = 0; ///< most of one batch that still shows soon
    double queueing_seconds = 0; ///< how long a batch waits for those before it
};

/// The smallest of the values of the last ten seconds or so.
class WindowedMinimum {
public:
    void add(double now, double value);
    void clear() { *this = {}; }
    /// Infinite where there is none.
    double least() const;

private:
    double begun_ = 0; ///< the newer half
    double older_ = std::numeric_limits<double>::infinity();
    double newer_ = std::numeric_limits<double>::infinity();
};

class LinkEstimate {
public:
    LinkEstimate();

    /// Batches count up by one from 1. One of so many samples is being made; it counts with the bytes to be expected.
    void begin(double samples);
    /// It has been handed to the socket. Times are of one steady clock, seconds. Does nothing for one that is
    /// acknowledged already.
    void sent(std::uint64_t batch, double now, double bytes);
    /// The viewer has answered this batch, and with it all before. `received`: when the batch had arrived by the
    /// viewer's own clock, seconds from any moment; what it says is not relied on alone.
    void acknowledged(std::uint64_t batch, double now, std::optional<double> received);

    /// The way to the viewer is another one: nothing is known of it. All batches up to this one are answered; so many
    /// later ones are sent once more.
    void restart(std::uint64_t acknowledged, std::size_t in_flight);

    /// True when another batch may be sent: less is in flight than the window holds, and what was sent before has had
    /// its time on the link. The batch that fills the window may exceed it.
    bool has_room(double now) const;
    double in_flight_bytes() const { return in_flight_; }
    double window_bytes() const { return window_; }
    LinkState state() const;

private:
    struct Flight {
        double samples = 0;
        double bytes = 0;
        std::optional<double> sent;
    };
    struct Waited {
        double when = 0, seconds = 0;
    };

    double measure_queue(Flight const& flight, double now, double round_trip, double arrived);
    bool is_full() const;
    double measured_rate() const;
    void measure_rate(double first_sent, double bytes, double arrived);
    void adapt(double now, double bytes, double queue);

    std::uint64_t acknowledged_ = 0; ///< batches
    std::deque<Flight> flights_; ///< begun and not acknowledged, in order
    double in_flight_ = 0; ///< bytes
    bool was_full_ = false; ///< the window, as long as it is being found

    WindowedMinimum base_; ///< round trips, seconds
    WindowedMinimum base_way_; ///< differences of arrival by the viewer's clock and sending by ours
    std::optional<double> last_arrived_;
    bool has_viewer_clock_ = false;
    std::deque<Waited> waited_; ///< lately
    double busy_bytes_ = 0, busy_seconds_ = 0; ///< while the link was busy, older ones counting less

    bool held_up_ = false; ///< the window left no room for more, lately
    bool starting_ = true; ///< no queue has been met
    double rate_ = 0; ///< bytes a second, once a queue has been met
    double ceiling_ = 0; ///< the rate before it fell last
    double window_; ///< bytes
    double paced_ = 0; ///< until when the link is busy at this rate
    bool queued_ = false; ///< a queue stands
    double growth_ = 1; ///< of the rate, at the next step upwards
    double grown_ = 0; ///< when a step upwards was tried last, or the rate had to fall
    double used_ = 0; ///< bytes sent since then
    double bytes_per_sample_;
    double delivery_seconds_ = 0;
    double queueing_seconds_ = 0;
};

} // namespace framelet
