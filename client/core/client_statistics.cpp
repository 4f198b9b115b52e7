#include "client/core/client_statistics.h"

namespace framelet {
namespace {

double ratio(double amount, std::uint64_t count) {
    return count == 0 ? 0 : amount / static_cast<double>(count);
}

} // namespace

double ClientStatistics::bytes_per_sample() const {
    return ratio(static_cast<double>(bytes), samples);
}

double ClientStatistics::decode_ns_per_sample() const {
    return ratio(decode_seconds * 1e9, samples);
}

double ClientStatistics::reconstruct_ns_per_pixel() const {
    return ratio(reconstruct_seconds * 1e9, pixels);
}

} // namespace framelet
