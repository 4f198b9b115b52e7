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

Growth growth_of(std::span<double const> before, std::span<double const> after) {
    FRAMELET_CHECK(before.size() == after.size() && before.size() >= 2);
    auto const count = static_cast<double>(before.size());
    Growth growth{0, 0, 0, before.size()};
    for (std::size_t i = 0; i < before.size(); ++i) {
        growth.mean += (after[i] - before[i]) / count;
        growth.before += before[i] / count;
    }
    double squares = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        double const off = after[i] - before[i] - growth.mean;
        squares += off * off;
    }
    growth.error = std::sqrt(squares / (count - 1) / count);
    return growth;
}

bool grows(Growth const& growth, double share) {
    // Quantile of Student's t that chance exceeds in one of a thousand cases, approximate to some percent from four
    // degrees of freedom on: 7.17, 4.14 with ten, 3.09 with many.
    double const freedom = static_cast<double>(growth.pairs) - 1;
    double const most_by_chance = 3.09 + 9.2 / freedom + 28 / (freedom * freedom);
    return growth.mean > most_by_chance * growth.error && growth.mean > share * growth.before;
}

} // namespace framelet::bench
