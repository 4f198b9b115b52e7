#include "common/color.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace framelet {

namespace {

float smaller(float a, float b) {
    return a < b ? a : b;
}
float larger(float a, float b) {
    return a > b ? a : b;
}
float to_unit(float value) {
    return larger(smaller(value, 1), 0);
}

/// The curve itself, without branches, so that a loop over samples becomes vector code.
inline void tone_map(float& red, float& green, float& blue) {
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

} // namespace

Vec3 tone_map(Vec3 color) {
    tone_map(color.r, color.g, color.b);
    return color;
}

float srgb_from_linear(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

float linear_from_srgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

namespace {

TransferTables make_tables() {
    TransferTables out;
    for (int i = 0; i < 256; ++i) {
        out.linear[static_cast<std::size_t>(i)] = linear_from_srgb(static_cast<float>(i) / 255.0f);
    }
    for (int i = 0; i <= TransferTables::steps; ++i) {
        float const value = srgb_from_linear(static_cast<float>(i) / TransferTables::steps);
        out.encoded[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255 * value));
    }
    return out;
}

TransferTables const tables = make_tables();

} // namespace

TransferTables const& transfer_tables() {
    return tables;
}

float linear_from_srgb_byte(std::uint8_t encoded) {
    return tables.linear[encoded];
}

std::uint8_t srgb_byte_from_linear(float linear) {
    // Written so that NaN compares false and lands on 0.
    float const clamped = linear > 0 ? (linear < 1 ? linear : 1.0f) : 0.0f;
    return tables.encoded[static_cast<std::size_t>(clamped * TransferTables::steps + 0.5f)];
}

DisplayFramelet to_display(Framelet const& framelet, float exposure) {
    std::array<std::array<std::int32_t, framelet_samples>, 3> steps;
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        float red = framelet.red[i] * exposure;
        float green = framelet.green[i] * exposure;
        float blue = framelet.blue[i] * exposure;
        tone_map(red, green, blue);
        steps[0][i] = static_cast<std::int32_t>(red * TransferTables::steps + 0.5f);
        steps[1][i] = static_cast<std::int32_t>(green * TransferTables::steps + 0.5f);
        steps[2][i] = static_cast<std::int32_t>(blue * TransferTables::steps + 0.5f);
    }
    DisplayFramelet out;
    out.tile = framelet.tile;
    std::uint8_t const* const encoded = tables.encoded.data(); // a copy: bytes written below might alias the original
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        out.red[i] = encoded[steps[0][i]];
        out.green[i] = encoded[steps[1][i]];
        out.blue[i] = encoded[steps[2][i]];
    }
    return out;
}

float display_luma(Vec3 radiance, float exposure) {
    Vec3 const shown = tone_map(radiance * exposure);
    return display_luma(srgb_byte_from_linear(shown.r), srgb_byte_from_linear(shown.g), srgb_byte_from_linear(shown.b));
}

} // namespace framelet
