// What a sender learns of a link from the receiver's answers, and how large the next frame may be. In: bytes and
// seconds of each message that has arrived, bytes that still wait. Out: bytes.
//
// The receiver times every message from its first byte to its last: while a message passes, the bottleneck is busy with
// it, whatever the delay before, so that bytes / seconds is the link's rate (packet-train dispersion).
#pragma once

namespace framelet::bench {

/// Running estimate.
struct DeliveryRate {
    double bytes_per_second = 0; ///< infinite: unlimited
};

/// Takes a message into account: a lower rate is believed at once, since what is too much waits in a queue, a higher
/// one by half. `seconds`: between its first and last byte; 0: no limit was felt.
DeliveryRate update_delivery_rate(DeliveryRate rate, double bytes, double seconds);

/// Bytes of a frame that is to be through before the next one comes, a `period` later: a share of what the link carries
/// meanwhile, less what still waits from frames before the last. `waiting_bytes`: sent and not on the way yet, now,
/// at the start of the frame.
double frame_budget(DeliveryRate rate, double period, double waiting_bytes);

} // namespace framelet::bench
