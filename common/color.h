// From scene-linear radiance to display bytes and back: exposure, tone curve, sRGB transfer function.
#pragma once

#include <array>
#include <cstdint>

#include "common/framelet.h"
#include "common/math.h"

namespace framelet {

/// Khronos PBR Neutral tone curve: leaves base colours below 0.8 as they are and rolls highlights off towards white.
/// In: linear Rec.709 colour, >= 0. Out: [0, 1]. (Khronos Group, "PBR Neutral Tone Mapper", 2024.)
Vec3 tone_map(Vec3 linear);

/// sRGB transfer function (IEC 61966-2-1) on [0, 1], and its inverse.
float srgb_from_linear(float linear);
float linear_from_srgb(float encoded);

/// Table form for bytes: exact inverse of rounding `srgb_from_linear`.
float linear_from_srgb_byte(std::uint8_t encoded);
/// Nearest byte by table: at most half a step of the byte off near the middle of a step, clamps outside [0, 1], NaN is
/// 0.
std::uint8_t srgb_byte_from_linear(float linear);

/// The tables behind the two functions above, for inner loops that index them directly.
struct TransferTables {
    static constexpr int steps = 1 << 14; ///< fine enough that the steepest part of the curve moves < 0.5 byte a step
    std::array<float, 256> linear{}; ///< by sRGB byte
    std::array<std::uint8_t, steps + 1> encoded{}; ///< by round(linear * steps)
};
TransferTables const& transfer_tables();

/// What a viewer gets to see of a rendered framelet. `exposure` multiplies radiance (2^EV).
DisplayFramelet to_display(Framelet const& framelet, float exposure);

/// Luma by which errors are judged: (R + 2 G + B) / 4 of the display-encoded bytes, [0, 1].
constexpr float display_luma(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
    return static_cast<float>(red + 2 * green + blue) / (4 * 255.0f);
}
/// The same of radiance as `to_display` shows it.
float display_luma(Vec3 radiance, float exposure);

} // namespace framelet
