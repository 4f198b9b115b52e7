#include "server/program/progress_line.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "common/one_line.h"

namespace framelet {
namespace {

constexpr std::size_t what_columns = 24;
constexpr int bar_columns = 16;

std::string time_text(double seconds) {
    std::array<char, 32> text{};
    auto const whole = static_cast<long>(seconds);
    if (seconds < 60) {
        std::snprintf(text.data(), text.size(), "%.1f s", seconds);
    } else if (seconds < 3600) {
        std::snprintf(text.data(), text.size(), "%ld min %02ld s", whole / 60, whole % 60);
    } else {
        std::snprintf(text.data(), text.size(), "%ld h %02ld min", whole / 3600, whole % 3600 / 60);
    }
    return text.data();
}

/// The text in its columns, cut between characters (UTF-8) where it is too long.
std::string in_columns(std::string_view text) {
    auto const is_first_byte = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
    std::string out;
    std::size_t columns = 0;
    for (char const c : text) {
        columns += is_first_byte(c) ? 1 : 0;
        if (columns > what_columns) {
            break;
        }
        out += c;
    }
    return out + std::string(what_columns - std::min(columns, what_columns), ' ');
}

} // namespace

std::string progress_line(std::string_view what, double fraction, double seconds) {
    double const done = std::clamp(fraction, 0.0, 1.0);
    auto const filled = static_cast<std::size_t>(bar_columns * done);
    std::array<char, 16> percent{};
    std::snprintf(percent.data(), percent.size(), "%3d%%", static_cast<int>(100 * done));
    std::string line = in_columns(to_one_line(what)) + " [" + std::string(filled, '#') +
                       std::string(bar_columns - filled, ' ') + "] " + percent.data() + "  " + time_text(seconds);
    constexpr double most_seconds = 100 * 3600; // beyond that it is no forecast
    double const left = done > 0 ? seconds * (1 - done) / done : most_seconds;
    if (seconds >= 1 && done < 1 && left < most_seconds) {
        line += ", " + time_text(left) + " left";
    }
    return line;
}

} // namespace framelet
