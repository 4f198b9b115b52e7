#include "tests/evaluation/charts/chart_style.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/evaluation/charts/gnuplot.h"

namespace framelet::bench {
namespace {

std::map<std::string, LineStyle> const methods{
    {"framed", {"#333333", 1, 5}},       {"interruptible", {"#e69f00", 1, 9}}, {"framed+h264", {"#0072b2", 1, 11}},
    {"framed+warp", {"#56b4e9", 1, 13}}, {"frameless", {"#cc79a7", 1, 4}},     {"afr", {"#009e73", 1, 8}},
    {"tsar", {"#882255", 1, 10}},        {"framelet", {"#d55e00", 1, 7, 3}},   {"framelet-unwarped", {"#ee9966", 2, 7}},
};

constexpr double tolerance = 1e-9; // relative tolerance for a mark that should stand on the end of its axis

std::string mark_label(int mantissa, int exponent) {
    if (exponent >= -3 && exponent <= 4) {
        return number(exponent < 0 ? mantissa / std::pow(10.0, -exponent) : mantissa * std::pow(10.0, exponent));
    }
    std::string const power = "10^{" + std::to_string(exponent) + "}";
    return mantissa == 1 ? power : std::to_string(mantissa) + "×" + power;
}

} // namespace

LineStyle style_of(std::string const& name) {
    auto const method = methods.find(name);
    return method != methods.end() ? method->second : LineStyle{"#999999", 1, 1, 1.5};
}

std::string to_string(LineStyle const& style) {
    return "lc rgb '" + style.color + "' lw " + number(style.width) + " dt " + std::to_string(style.dash) + " pt " +
           std::to_string(style.point) + " ps 0.9";
}

std::string common_look(std::string const& title) {
    return "reset\n"
           "set border 3 lw 1 lc rgb '#666666'\n"
           "set tics out nomirror scale 0.6,0.3 textcolor rgb '#333333'\n"
           "set grid xtics ytics lt 1 lw 0.7 lc rgb '#e0e0e0'\n"
           "set key outside right top Left reverse samplen 2.5 spacing 1.3 noenhanced\n"
           "set title " +
           quoted(title) + " noenhanced font ',14'\n";
}

Range log_range(std::span<double const> values) {
    double low = INFINITY, high = 0;
    bool beneath = false;
    for (double const value : values) {
        if (!std::isfinite(value)) {
            continue;
        }
        beneath = beneath || value <= 0;
        if (value > 0) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    if (high <= 0) {
        return {0.1, 1};
    }
    constexpr double least_ratio = 4;
    if (high / low < least_ratio) {
        double const widen = std::sqrt(least_ratio * low / high);
        low /= widen;
        high *= widen;
    }
    return {beneath ? low / 2 : low, high};
}

double on_log_axis(double value, Range const& range) {
    return std::clamp(value, range.low, range.high);
}

std::string log_axis(std::string const& axis, Range const& range, double marked_low, double marked_high) {
    double const decades = std::log10(marked_high / marked_low);
    bool const few = decades < 2; // there are too few powers of ten, so that 2 and 5 times a power are named as well
    int const step = std::max(1, static_cast<int>(std::ceil(decades / 9)));
    std::string marks;
    int const last = static_cast<int>(std::ceil(std::log10(marked_high)));
    for (int e = static_cast<int>(std::floor(std::log10(marked_low))); e <= last; ++e) {
        for (int mantissa = 1; mantissa < 10; ++mantissa) {
            double const value = mantissa * std::pow(10.0, e);
            if (value < marked_low * (1 - tolerance) || value > marked_high * (1 + tolerance)) {
                continue;
            }
            bool const named = mantissa == 1 ? e % step == 0 : few && (mantissa == 2 || mantissa == 5);
            marks += marks.empty() ? "" : ", ";
            marks += quoted(named ? mark_label(mantissa, e) : "") + " " + number(value) + (named ? " 0" : " 1");
        }
    }
    return "set logscale " + axis + "\nset " + axis + "range [" + number(range.low) + ":" + number(range.high) +
           "]\nset " + axis + "tics enhanced (" + marks + ")\n";
}

std::string axis_title(std::string const& axis, std::string const& title) {
    return "set " + axis + "label " + quoted(title) + " noenhanced\n";
}

} // namespace framelet::bench
