// Converts scene-linear radiance to display bytes and back: exposure, tone curve, sRGB transfer function.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "common/math.h"

namespace framelet {

/// The PBR Neutral tone curve ([Khronos 2024]): leaves base colours below 0.8 as they are and rolls highlights off
/// towards white. In: linear Rec.709 colour, >= 0. Out: [0, 1].
Vec3 tone_map(Vec3 linear);
/// Applies the same curve in place, without branches, so that a loop over samples becomes vector code.
inline void tone_map(float& red, float& green, float& blue) {
    auto const smaller = [](float a, float b) { return a < b ? a : b; };
    auto const larger = [](float a, float b) { return a > b ? a : b; };
    auto const to_unit = [&](float value) { return larger(smaller(value, 1), 0); };
    constexpr float start_compression = 0.8f - 0.04f;
    constexpr float desaturation = 0.15f;
    constexpr float d = 1 - start_compression;
    float const low = smaller(smaller(red, green), blue);
    float const offset = low < 0.08f ? low - 6.25f * low * low : 0.04f;
    red -= offset;
    green -= offset;
    blue -= offset;
    float const peak = larger(larger(red, green), blue);
    // Below the start of the compression both factors come out as "change nothing".
    float const excess = larger(peak - start_compression, 0);
    float const new_peak = excess > 0 ? 1 - d * d / (excess + d) : peak;
    float const scale = excess > 0 ? new_peak / larger(peak, start_compression) : 1;
    float const white = excess > 0 ? 1 - 1 / (desaturation * (peak - new_peak) + 1) : 0;
    red = to_unit(red * scale * (1 - white) + new_peak * white);
    green = to_unit(green * scale * (1 - white) + new_peak * white);
    blue = to_unit(blue * scale * (1 - white) + new_peak * white);
}

enum class ToneCurve : std::uint8_t {
    neutral, ///< as above
    aces, ///< the film look of ACES as [Hill 2017] fits it; as bright as three.js and model-viewer have it
    agx, ///< [Sobotka 2023] as Blender has it without a look, its contrast by the polynomial of [Wrensch 2023]
    linear, ///< as it is, cut off at 1
};
/// The curve of this name. Throws InputError for other words.
ToneCurve parse_tone_curve(std::string const& word);
/// Applies a curve. In: linear Rec.709 colour, >= 0. Out: [0, 1].
Vec3 tone_map(Vec3 linear, ToneCurve curve);

/// How radiance becomes what a display shows.
struct DisplayTransform {
    float exposure = 1; ///< factor on radiance (2^EV)
    ToneCurve curve = ToneCurve::neutral;

    DisplayTransform() = default;
    DisplayTransform(float factor, ToneCurve tone = ToneCurve::neutral) : exposure(factor), curve(tone) {} // NOLINT
    bool operator==(DisplayTransform const&) const = default;
    /// Linear Rec.709 colour that is shown, [0, 1].
    Vec3 shown(Vec3 const& radiance) const { return tone_map(radiance * exposure, curve); }
};

/// sRGB transfer function ([IEC 61966-2-1]) on [0, 1], and its inverse.
float srgb_from_linear(float linear);
float linear_from_srgb(float encoded);

/// Table form for bytes: exact inverse of rounding `srgb_from_linear`.
float linear_from_srgb_byte(std::uint8_t encoded);
/// Finds the nearest byte by table: at most half a step of the byte off near the middle of a step. Values outside
/// [0, 1] are clamped, and NaN gives 0.
std::uint8_t srgb_byte_from_linear(float linear);

/// The tables behind the two functions above, for inner loops that index them directly.
struct TransferTables {
    static constexpr int steps = 1 << 14; ///< fine enough that the steepest part of the curve moves < 0.5 byte a step
    std::array<float, 256> linear{}; ///< by sRGB byte
    std::array<std::uint8_t, steps + 1> encoded{}; ///< by round(linear * steps)
};
TransferTables const& transfer_tables();

/// Luma by which errors are judged: (R + 2 G + B) / 4 of the display-encoded bytes, [0, 1].
constexpr float display_luma(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
    return static_cast<float>(red + 2 * green + blue) / (4 * 255.0f);
}
/// The same luma of radiance as a viewer sees it.
float display_luma(Vec3 radiance, DisplayTransform const& display);

} // namespace framelet
