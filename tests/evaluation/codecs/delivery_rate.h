// Estimates a link's rate from the receiver's answers, and how large the next frame may be. In: bytes and seconds of
// each message that has arrived, bytes that still wait. Out: bytes.
//
// The receiver times every message from its first byte to its last: while a message passes, the bottleneck is busy with
// it, whatever the delay before, so that bytes / seconds is the link's rate (packet-train dispersion).
#pragma once

namespace framelet::bench {

/// Running estimate of a link's rate.
struct DeliveryRate {
    double bytes_per_second = 0; ///< infinite: unlimited
};

/// Updates the estimate by a message: a lower rate is adopted at once, since bytes in excess wait in a queue; towards a
/// higher one the estimate goes half of the way. `seconds`: time between its first and last byte; 0: no limit was felt.
DeliveryRate update_delivery_rate(DeliveryRate rate, double bytes, double seconds);

/// Bytes that a frame may have so as to be through before the next one comes, `period` seconds later: a share of what
/// the link carries meanwhile, less what still waits from frames before the last. `waiting_bytes`: bytes sent and not
/// on the way yet, now, at the start of the frame.
double frame_budget(DeliveryRate rate, double period, double waiting_bytes);

} // namespace framelet::bench
