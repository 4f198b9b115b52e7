#include "tests/evaluation/codecs/delivery_rate.h"

#include <algorithm>
#include <cmath>

namespace framelet::bench {
namespace {

/// Share of what the link carries that a frame may use: the rest is room for what an encoder overshoots by.
constexpr double link_share = 0.95;
/// Share that a frame gets however much waits, so that some picture is always sent.
constexpr double least_share = 0.1;

} // namespace

DeliveryRate update_delivery_rate(DeliveryRate rate, double bytes, double seconds) {
    double const seen = seconds > 0 ? bytes / seconds : INFINITY;
    if (seen < rate.bytes_per_second || !std::isfinite(seen)) {
        return {seen};
    }
    return {rate.bytes_per_second + 0.5 * (seen - rate.bytes_per_second)};
}

double frame_budget(DeliveryRate rate, double period, double waiting_bytes) {
    double const carried = rate.bytes_per_second * period;
    if (!std::isfinite(carried)) {
        return INFINITY;
    }
    double const late = std::max(0.0, waiting_bytes - carried); // bytes that still wait when this frame is ready
    return std::max(link_share * carried - late, least_share * carried);
}

} // namespace framelet::bench
