// Helpers that the report's tables and charts share: setting of text, selection of runs.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "tests/evaluation/report/report_runs.h"

namespace framelet::bench {

/// Mean squared errors below this are due to rounding to bytes.
inline constexpr double least_mse = 1e-9;

/// Shaded samples a second of one core where every sample has a shadow ray and a quarter mirror; the bundled scenes
/// reach a third to a half of it.
inline constexpr double core_rate = 5.3e6;
inline constexpr double screen_pixels = 1920.0 * 1080;

[[gnu::format(printf, 1, 2)]] std::string printed(char const* format, ...);

/// The text in bold, or as it is.
std::string bold_if(bool is_bold, std::string const& text);

/// The Markdown page with the lines of each paragraph filled up to 120 characters; tables, headings, pictures and code
/// stay as they are.
std::string wrapped(std::string const& page);

/// True if the method is neither the project's nor a yardstick that knows the truth.
bool is_rival(std::string const& method);

/// The values of `get` over the runs, without repetition, in the order in which they come first.
template <class Get>
auto distinct(std::vector<ReportRun> const& runs, Get&& get) {
    std::vector<std::decay_t<std::invoke_result_t<Get, ReportRun const&>>> found;
    for (ReportRun const& run : runs) {
        if (std::ranges::find(found, std::invoke(get, run)) == found.end()) {
            found.push_back(std::invoke(get, run));
        }
    }
    return found;
}

template <class Belongs>
std::vector<ReportRun> part(std::vector<ReportRun> const& runs, Belongs&& belongs) {
    std::vector<ReportRun> result;
    std::ranges::copy_if(runs, std::back_inserter(result), belongs);
    return result;
}

/// The runs without a link's limit.
inline std::vector<ReportRun> unlimited(std::vector<ReportRun> const& runs) {
    return part(runs, [](ReportRun const& run) { return run.link == 0; });
}

} // namespace framelet::bench
