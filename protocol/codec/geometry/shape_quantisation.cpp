#include "protocol/codec/geometry/shape_quantisation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/error.h"

namespace framelet {
namespace {

constexpr int unit_bias = 128;

/// A value in units, rounded and clamped to what the type holds.
template <typename Number>
Number rounded(double value, UnitCode unit) {
    using Limits = std::numeric_limits<Number>;
    double const units = unit == 0 ? 0 : std::nearbyint(value / unit_of(unit));
    return static_cast<Number>(std::clamp<double>(units, Limits::lowest(), Limits::max()));
}

} // namespace

double unit_of(UnitCode code) {
    return code == 0 ? 0 : std::ldexp(1.0, code - unit_bias);
}

UnitCode unit_above(double value) {
    FRAMELET_CHECK(value >= 0 && std::isfinite(value));
    if (value == 0) {
        return 0;
    }
    int exponent = 0;
    std::frexp(value, &exponent);
    return static_cast<UnitCode>(std::clamp(exponent + unit_bias, 1, int{largest_unit}));
}

LayerCode quantise(Layer const& layer, int side_bits) {
    constexpr double error_units = 16, plane_units = 1 << 10;
    double const side = std::ldexp(1.0, side_bits);
    double const at = layer.at, dx = layer.dx, dy = layer.dy, error = layer.error;
    double const magnitude = std::abs(at) + side * (std::abs(dx) + std::abs(dy));
    LayerCode code;
    code.unit = unit_above(std::max(error / error_units, magnitude / plane_units));
    code.at = rounded<std::int16_t>(at, code.unit);
    code.dx = rounded<std::int16_t>(dx * side, code.unit);
    code.dy = rounded<std::int16_t>(dy * side, code.unit);
    if (code.unit != 0) {
        Layer const plane = dequantise(code, side_bits);
        double const off =
            std::abs(at - static_cast<double>(plane.at)) +
            side * (std::abs(dx - static_cast<double>(plane.dx)) + std::abs(dy - static_cast<double>(plane.dy)));
        code.error = static_cast<std::uint8_t>(std::min(std::ceil((error + off) / unit_of(code.unit)), 255.0));
    }
    return code;
}

Layer dequantise(LayerCode const& code, int side_bits) {
    double const unit = unit_of(code.unit);
    double const gradient = std::ldexp(unit, -side_bits);
    Layer layer;
    layer.at = static_cast<float>(code.at * unit);
    layer.dx = static_cast<float>(code.dx * gradient);
    layer.dy = static_cast<float>(code.dy * gradient);
    layer.error = static_cast<float>(code.error * unit);
    return layer;
}

std::uint8_t quantise_inverse_depth(float inverse_depth, UnitCode unit) {
    return rounded<std::uint8_t>(static_cast<double>(inverse_depth), unit);
}

std::int16_t quantise_drift(float component, UnitCode unit) {
    return rounded<std::int16_t>(static_cast<double>(component), unit);
}

JerkCode quantise_jerk(float jerk) {
    FRAMELET_CHECK(jerk >= 0);
    if (jerk == 0) {
        return 0;
    }
    constexpr float rounding = 1e-3f; // of the logarithm: what a reader has made of a code has that code
    return static_cast<JerkCode>(std::clamp(std::ceil(8 * std::log2(jerk) + unit_bias - rounding), 1.0f, 255.0f));
}

float jerk_of(JerkCode code) {
    return code == 0 ? 0.0f : std::exp2(static_cast<float>(code - unit_bias) / 8);
}

} // namespace framelet
