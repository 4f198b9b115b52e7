// What a client says of its frames, by `--frames`. For tests only.
#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace framelet::test {

struct Shown {
    double seconds = 0; ///< Unix time
    double samples = 0; ///< that have come so far
};

inline std::vector<Shown> shown_in(std::string const& lines) {
    std::vector<Shown> all;
    std::istringstream in(lines);
    for (std::string line; std::getline(in, line) && !in.eof();) { // the last line may not be whole yet
        auto const frame = nlohmann::json::parse(line);
        all.push_back({frame.at("unix_seconds").get<double>(), frame.at("samples").get<double>()});
    }
    return all;
}

/// The longest time without a new sample from `since` on, seconds.
inline double longest_gap(std::vector<Shown> const& shown, double since) {
    double longest = 0, last = 0, samples = -1;
    for (Shown const& frame : shown) {
        if (frame.samples != samples) {
            longest = last > 0 && frame.seconds >= since ? std::max(longest, frame.seconds - last) : longest;
            samples = frame.samples;
            last = frame.seconds;
        }
    }
    return longest;
}

} // namespace framelet::test
