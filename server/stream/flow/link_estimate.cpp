#include "server/stream/flow/link_estimate.h"

#include <algorithm>
#include <cmath>

namespace framelet {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Half of the time that a minimum remembers, seconds.
constexpr double half_window = 5;

/// The queue that the window leaves room for, seconds: enough that the link has always something to carry.
constexpr double wanted_queue = 0.015;
/// A standing queue of more seconds than this is too much.
constexpr double most_queue = 0.03;
/// A queue of so many seconds stands; one of less than half of them leaves room to try more.
constexpr double least_queue = 0.012;
/// Seconds for which a queue has to last to count as standing.
constexpr double standing_seconds = 0.05;
/// A fast link gets a shorter queue, bytes and seconds: what is on its way when it turns slow has to be through within
/// a second.
constexpr double most_queue_bytes = 64e3, fast_queue = 0.006;
/// Factors on the rate for a step upwards, the first and the greatest; and the queue, seconds, that a step makes at
/// most until it is seen to stand.
constexpr double first_growth = 1.03, most_growth = 1.5, tried_queue = 0.02;
/// A step upwards has been tried when this share of the rate was sent since. Nobody knows that a rate is carried which
/// nothing was sent at, and the next burst would find out. The share is less than what a QP that is kept makes use of.
constexpr double tried_share = 0.85;
/// Factor on the rate for a step upwards as long as the rate is below `known_share` of what it was before it fell.
constexpr double known_growth = 1.5, known_share = 0.5;
/// Seconds after a queue in which no step upwards is tried.
constexpr double quiet_seconds = 0.1;
/// Share of the rate at which batches are sent while a queue stands.
constexpr double draining_share = 0.8;
/// Seconds that the next batch may be begun before its time comes, and that one which is late may make up for.
constexpr double slack_seconds = 0.01;
/// The largest size of a batch, as seconds on the link or as a share of the window, the last one while the window is
/// being found.
constexpr double batch_seconds = 0.01, batch_share = 0.125, first_batch_share = 0.25;
/// Share of the window that counts as all of it while the window is being found.
constexpr double first_used_share = 0.2;
/// Seconds over which the measured rate is a mean, and the most that one batch counts for: a stall is no rate.
constexpr double rate_memory = 0.1, most_weight = 0.1;
constexpr double least_rate = 1e3, most_rate = 1e12;
/// Bytes of the first window, ten segments as TCP's own ([RFC 6928]), and of the smallest.
constexpr double first_window = 14.6e3, least_window = 4e3;
/// Bytes of a sample that are assumed before the first batch: with loss, and its shape.
constexpr double first_bytes_per_sample = 0.4;
/// Weight of a new value in a running mean.
constexpr double news = 0.125;

double window_of(double rate, double base) {
    double const queue = std::min(rate * wanted_queue, std::max(most_queue_bytes, rate * fast_queue));
    return std::max(least_window, rate * base + queue);
}

} // namespace

void WindowedMinimum::add(double now, double value) {
    if (!(now - begun_ < half_window)) {
        older_ = now - begun_ < 2 * half_window ? newer_ : infinity;
        newer_ = infinity;
        begun_ = now;
    }
    newer_ = std::min(newer_, value);
}

double WindowedMinimum::least() const {
    return std::min(older_, newer_);
}

LinkEstimate::LinkEstimate() : window_(first_window), bytes_per_sample_(first_bytes_per_sample) {}

LinkState LinkEstimate::state() const {
    LinkState state;
    state.bytes_per_sample = bytes_per_sample_;
    state.delivery_seconds = delivery_seconds_;
    double const base = base_.least();
    bool const is_answered = std::isfinite(base);
    state.base_seconds = is_answered ? base : 0;
    if (!starting_) {
        state.bytes_per_second = rate_;
        state.batch_bytes = std::max(batch_seconds * rate_, batch_share * window_);
    } else {
        state.bytes_per_second = held_up_ && is_answered ? window_ / std::max(base, least_round_trip) : infinity;
        state.batch_bytes = base < least_round_trip ? infinity : first_batch_share * window_;
    }
    return state;
}

/// True where so much is in flight that a larger window is worth trying. While no queue has been met, a part of the
/// window suffices for that: the renderer may have no more.
bool LinkEstimate::is_full() const {
    return in_flight_ >= (starting_ ? first_used_share : 1) * window_;
}

bool LinkEstimate::has_room(double now) const {
    return in_flight_ < std::min(window_, most_in_flight) && (starting_ || now >= paced_ - slack_seconds);
}

void LinkEstimate::restart(std::uint64_t acknowledged, std::size_t in_flight) {
    double const bytes_per_sample = bytes_per_sample_;
    *this = LinkEstimate();
    bytes_per_sample_ = bytes_per_sample;
    acknowledged_ = acknowledged;
    flights_.resize(in_flight);
}

void LinkEstimate::begin(double samples) {
    flights_.push_back({samples, bytes_per_sample_ * samples, {}});
    in_flight_ += flights_.back().bytes;
    was_full_ = was_full_ || is_full();
}

void LinkEstimate::sent(std::uint64_t batch, double now, double bytes) {
    if (batch <= acknowledged_ || batch - acknowledged_ > flights_.size()) {
        return;
    }
    Flight& flight = flights_[static_cast<std::size_t>(batch - acknowledged_ - 1)];
    in_flight_ += bytes - flight.bytes;
    held_up_ = held_up_ || in_flight_ >= window_;
    flight.bytes = bytes;
    flight.sent = now;
    was_full_ = was_full_ || is_full();
    if (!starting_) {
        double const rate = queued_ ? draining_share * rate_ : rate_;
        used_ += bytes;
        paced_ = std::max(paced_, now - slack_seconds) + bytes / rate;
    }
    if (flight.samples > 0) {
        double const each = bytes / flight.samples;
        bytes_per_sample_ += news * (each - bytes_per_sample_);
    }
}

void LinkEstimate::acknowledged(std::uint64_t batch, double now, std::optional<double> received) {
    if (batch <= acknowledged_ || batch - acknowledged_ > flights_.size()) {
        return;
    }
    double bytes = 0;
    std::optional<double> const first_sent = flights_.front().sent;
    Flight last;
    for (; acknowledged_ < batch; ++acknowledged_) {
        last = flights_.front();
        bytes += last.bytes;
        flights_.pop_front();
    }
    in_flight_ = flights_.empty() ? 0 : std::max(0.0, in_flight_ - bytes);
    if (flights_.empty()) { // nothing waits: whatever the rate, soon something has to find out what the link carries
        paced_ = std::min(paced_, now + standing_seconds);
    }
    if (!first_sent || !last.sent) {
        return; // a guess, not an answer
    }
    bool const has_clock = received && std::isfinite(*received);
    double const arrived = has_clock ? *received : now;
    if (has_clock != has_viewer_clock_ || (last_arrived_ && arrived < *last_arrived_)) {
        base_way_.clear(); // another clock, or one that was set
        last_arrived_.reset();
        has_viewer_clock_ = has_clock;
    }
    double const round_trip = std::max(0.0, now - *last.sent);
    base_.add(now, round_trip);
    base_way_.add(now, arrived - *last.sent);
    measure_rate(*first_sent, bytes, arrived);
    double const queue = measure_queue(last, now, round_trip, arrived);
    double const delivery = std::max(0.0, round_trip - 0.5 * base_.least());
    delivery_seconds_ += (delivery_seconds_ > 0 ? news : 1) * (delivery - delivery_seconds_);
    last_arrived_ = arrived;
    adapt(now, bytes, queue);
}

/// Counts the time for which the link was busy with what has just arrived: since the batch before, or since it was sent
/// itself.
void LinkEstimate::measure_rate(double first_sent, double bytes, double arrived) {
    double const began = std::max(last_arrived_.value_or(-infinity), first_sent + base_way_.least());
    double const seconds = std::max(0.0, arrived - began);
    double const kept = std::exp(-(arrived - last_arrived_.value_or(arrived)) / rate_memory);
    double const weight = std::min(1.0, most_weight / seconds); // 1 for 0 seconds
    busy_bytes_ = kept * busy_bytes_ + weight * bytes;
    busy_seconds_ = kept * busy_seconds_ + weight * seconds;
}

double LinkEstimate::measured_rate() const {
    return busy_seconds_ > 0 ? std::clamp(busy_bytes_ / busy_seconds_, least_rate, most_rate) : most_rate;
}

/// Returns the least time, seconds, that any of the batches that came lately has waited; by both clocks, so that
/// neither a clock that was set nor a slow way back makes a queue.
double LinkEstimate::measure_queue(Flight const& flight, double now, double round_trip, double arrived) {
    double const own = starting_ ? 0 : flight.bytes / std::max(rate_, measured_rate());
    double const late = std::min(round_trip - base_.least(), arrived - *flight.sent - base_way_.least());
    double const seconds = std::max(0.0, late - own);
    while (!waited_.empty() && !(now - waited_.front().when < standing_seconds)) {
        waited_.pop_front();
    }
    while (!waited_.empty() && waited_.back().seconds >= seconds) {
        waited_.pop_back(); // never the smallest any more
    }
    waited_.push_back({now, seconds});
    return waited_.front().seconds;
}

void LinkEstimate::adapt(double now, double bytes, double queue) {
    double const base = base_.least();
    double const measured = measured_rate();
    if (starting_) {
        if (queue < most_queue) {
            window_ += was_full_ ? bytes : 0;
            was_full_ = is_full();
            held_up_ = held_up_ && in_flight_ >= 0.5 * window_;
            return;
        }
        starting_ = false;
        rate_ = measured;
    } else if (queue >= most_queue && measured < rate_) {
        ceiling_ = rate_;
        rate_ = measured; // at once: what is too much waits
    } else if (queue >= least_queue) {
        rate_ += 0.25 * (measured - rate_);
    } else if (queue < 0.5 * least_queue && now - grown_ >= 1.25 * base + standing_seconds) {
        if (used_ >= tried_share * rate_ * (now - grown_)) {
            bool const is_known = rate_ < known_share * ceiling_;
            // What is tried shows only a round trip later.
            growth_ = std::min({growth_ * growth_, most_growth, 1 + tried_queue / (base + standing_seconds)});
            rate_ = std::min((is_known ? known_growth : growth_) * rate_, most_rate);
        } else {
            growth_ = first_growth;
        }
        grown_ = now;
        used_ = 0;
    }
    queued_ = queue >= least_queue;
    if (queued_) {
        growth_ = first_growth;
        grown_ = now + quiet_seconds;
        used_ = 0;
    }
    window_ = window_of(rate_, base);
}

} // namespace framelet
