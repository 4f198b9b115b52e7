#include "client/core/client_statistics.h"

#include <algorithm>
#include <cstddef>

namespace framelet {
namespace {

double ratio(double amount, std::uint64_t count) {
    return count == 0 ? 0 : amount / static_cast<double>(count);
}

} // namespace

PictureState ClientStatistics::state() const {
    return converged ? PictureState::finished : is_fine ? PictureState::refining : PictureState::coarse;
}

char const* name_of(PictureState state) {
    return state == PictureState::finished ? "finished" : state == PictureState::refining ? "refining" : "coarse";
}

double ClientStatistics::bytes_per_sample() const {
    return ratio(static_cast<double>(bytes), samples);
}

double ClientStatistics::decode_ns_per_sample() const {
    return ratio(decode_seconds * 1e9, samples);
}

double ClientStatistics::reconstruct_ns_per_pixel() const {
    return ratio(reconstruct_seconds * 1e9, pixels);
}

double median_seconds(std::vector<double> times) {
    if (times.empty()) {
        return -1;
    }
    auto const middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    return *middle;
}

} // namespace framelet
