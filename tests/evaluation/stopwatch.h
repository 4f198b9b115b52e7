// Measures how long something takes.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

namespace framelet::bench {

template <class Work>
double seconds_of(Work&& work) {
    auto const start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Processor time of the calling thread alone: other threads and programs affect it little.
template <class Work>
double processor_seconds_of(Work&& work) {
    auto const now = [] {
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    };
    double const start = now();
    work();
    return now() - start;
}

/// Median; the upper one of the two middle values where their number is even; 0 of none.
inline double median(std::vector<double> values) {
    if (values.empty()) {
        return 0;
    }
    auto const middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace framelet::bench
