#include "tests/evaluation/soak/process_watch.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

#include "common/error.h"

namespace framelet::bench {

ProcessHoldings holdings_of(pid_t pid) {
    std::string const folder = "/proc/" + std::to_string(pid);
    ProcessHoldings held;
    double whole = 0, resident = 0;
    if (std::ifstream(folder + "/statm") >> whole >> resident) {
        held.resident_bytes = resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
    }
    std::error_code gone;
    for (std::filesystem::directory_iterator entry(folder + "/fd", gone), end; !gone && entry != end;
         entry.increment(gone)) {
        ++held.descriptors;
    }
    return held;
}

Trend trend_of(std::span<double const> times, std::span<double const> values) {
    FRAMELET_CHECK(times.size() == values.size() && times.size() >= 3);
    auto const count = static_cast<double>(times.size());
    double time = 0, value = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        time += times[i] / count;
        value += values[i] / count;
    }
    double squares = 0, products = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        squares += (times[i] - time) * (times[i] - time);
        products += (times[i] - time) * (values[i] - value);
    }
    FRAMELET_CHECK(squares > 0);
    Trend trend{products / squares, 0, value, times.size()};
    double residuals = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        double const off = values[i] - value - trend.slope * (times[i] - time);
        residuals += off * off;
    }
    trend.slope_error = std::sqrt(residuals / (count - 2) / squares);
    return trend;
}

bool grows(Trend const& trend, double span, double share) {
    // The quantile of Student's t, to some percent from four degrees of freedom on: 7.17, 4.14 with ten, 3.09 with
    // many.
    double const freedom = static_cast<double>(trend.points) - 2;
    double const most_by_chance = 3.09 + 9.2 / freedom + 28 / (freedom * freedom);
    return trend.slope > most_by_chance * trend.slope_error && trend.slope * span > share * trend.mean;
}

} // namespace framelet::bench
