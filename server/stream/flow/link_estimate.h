// Learns what the link to a viewer carries from what was sent and acknowledged. In: bytes and times. Out: the rate of
// the link, how long a batch takes, and whether another one may be sent now.
//
// The window is delay-based, as that of TCP Vegas [Brakmo 1995] and BBR [Cardwell 2016]: what is in flight is bounded
// to the rate of delivery times the shortest round trip seen lately and a small queue, whatever TCP would let through.
// A queue counts when it stands for a while (CoDel, [RFC 8289]), so that jitter is none.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

namespace framelet {

/// Seconds; a shorter round trip says nothing of a link: there is hardly one.
inline constexpr double least_round_trip = 0.002;

/// Bytes; so much in flight is enough for any link that viewers have, and bounds what a viewer that stops reading makes
/// the server keep.
inline constexpr double most_in_flight = 16e6;

struct LinkState {
    /// Rate of the link; infinite: it has not been felt yet. While the window is still being found, the rate that the
    /// window allows.
    double bytes_per_second = std::numeric_limits<double>::infinity();
    double bytes_per_sample = 0; ///< of what was sent lately, or will be first, with everything that goes with it
    double delivery_seconds = 0; ///< from sending until a batch has arrived, lately
    double base_seconds = 0; ///< the shortest round trip lately; 0: none is known
    double batch_bytes = 0; ///< most bytes of one batch that still shows soon
};

/// The smallest of the values of the last ten seconds or so. `now`: seconds.
class WindowedMinimum {
public:
    void add(double now, double value);
    void clear() { *this = {}; }
    /// The smallest value; infinite where there is none.
    double least() const;

private:
    double begun_ = 0; ///< when the newer half began, seconds
    double older_ = std::numeric_limits<double>::infinity();
    double newer_ = std::numeric_limits<double>::infinity();
};

class LinkEstimate {
public:
    LinkEstimate();

    /// Notes that a batch of so many samples is being made; it counts with the bytes to be expected. Batches count up
    /// by one from 1.
    void begin(double samples);
    /// Notes that a batch has been handed to the socket. Times are of one steady clock, seconds. Does nothing for a
    /// batch that is acknowledged already.
    void sent(std::uint64_t batch, double now, double bytes);
    /// Notes that the viewer has answered this batch, and with it all before. `received`: when the batch had arrived by
    /// the viewer's own clock, seconds from any moment; what it says is not relied on alone.
    void acknowledged(std::uint64_t batch, double now, std::optional<double> received);

    /// Begins anew: the link to the viewer is another one, of which nothing is known. All batches up to `acknowledged`
    /// are answered; `in_flight` later ones are sent once more.
    void restart(std::uint64_t acknowledged, std::size_t in_flight);

    /// True when another batch may be sent: less is in flight than the window holds and than `most_in_flight`, and what
    /// was sent before has had its time on the link. The batch that fills the window may exceed it.
    bool has_room(double now) const;
    double in_flight_bytes() const { return in_flight_; }
    double window_bytes() const { return window_; }
    LinkState state() const;

private:
    struct Flight {
        double samples = 0;
        double bytes = 0;
        std::optional<double> sent; ///< when it was handed to the socket, seconds; nothing: not yet
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
    std::deque<Flight> flights_; ///< batches begun and not acknowledged, in order
    double in_flight_ = 0; ///< bytes
    bool was_full_ = false; ///< the window was full, as long as it is being found

    WindowedMinimum base_; ///< round trips, seconds
    WindowedMinimum base_way_; ///< arrival by the viewer's clock less sending by ours, seconds
    std::optional<double> last_arrived_; ///< when the last batch had arrived, by the clock that says so, seconds
    bool has_viewer_clock_ = false; ///< that is the viewer's; else ours, by which the answer came
    std::deque<Waited> waited_; ///< how long batches have waited lately, seconds
    double busy_bytes_ = 0, busy_seconds_ = 0; ///< while the link was busy, older ones counting less

    bool held_up_ = false; ///< the window left no room for more, lately
    bool starting_ = true; ///< no queue has been met
    double rate_ = 0; ///< bytes a second, once a queue has been met
    double ceiling_ = 0; ///< the rate before it fell last, bytes a second
    double window_; ///< bytes
    double paced_ = 0; ///< until when the link is busy at this rate, seconds
    bool queued_ = false; ///< a queue stands
    double growth_ = 1; ///< factor on the rate at the next step upwards
    double grown_ = 0; ///< when a step upwards was tried last, or the rate had to fall, seconds
    double used_ = 0; ///< bytes sent since then
    double bytes_per_sample_;
    double delivery_seconds_ = 0;
};

} // namespace framelet
