// The style that all charts share: the look, the colour of each method, axes.
#pragma once

#include <span>
#include <string>

namespace framelet::bench {

struct LineStyle {
    std::string color; ///< "#rrggbb"
    int dash = 1; ///< gnuplot's dash type; 1 is solid
    int point = 7; ///< gnuplot's point type
    double width = 2;
};

/// Line style of a method of the evaluation, in colours that the colour-blind tell apart, after Okabe and Ito and P.
/// Tol. Other names are grey.
LineStyle style_of(std::string const& name);

/// The style as options of a plot command: "lc rgb ... lw ... dt ... pt ...".
std::string to_string(LineStyle const& style);

/// Commands for the look of a chart: light grid, grey axes left and below, the legend to the right. `title` is drawn as
/// it is.
std::string common_look(std::string const& title);

/// Range of one axis, low < high.
struct Range {
    double low = 0;
    double high = 1;
};

/// Range from the least to the greatest finite value above zero, at least a factor of four; where a value is zero or
/// less, half as far down again, so that what is drawn there is seen to be lower. [0.1, 1] if none is above zero.
Range log_range(std::span<double const> values);

/// Value at which `value` is drawn on a logarithmic axis: clamped to its range.
double on_log_axis(double value, Range const& range);

/// Commands that make `axis` ("x", "y") logarithmic. Its marks end at `marked_high`, which leaves the rest free for
/// text.
std::string log_axis(std::string const& axis, Range const& range, double marked_low, double marked_high);

/// Commands for an axis' title, drawn as it is.
std::string axis_title(std::string const& axis, std::string const& title);

} // namespace framelet::bench
