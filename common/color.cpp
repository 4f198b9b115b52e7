#include "common/color.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace framelet {

Vec3 tone_map(Vec3 color) {
    constexpr float start_compression = 0.8f - 0.04f;
    constexpr float desaturation = 0.15f;
    float const low = std::min({color.r, color.g, color.b});
    float const offset = low < 0.08f ? low - 6.25f * low * low : 0.04f;
    color -= offset;
    float const peak = std::max({color.r, color.g, color.b});
    if (peak < start_compression) {
        return glm::max(color, Vec3(0));
    }
    constexpr float d = 1 - start_compression;
    float const new_peak = 1 - d * d / (peak + d - start_compression);
    color *= new_peak / peak;
    float const g = 1 - 1 / (desaturation * (peak - new_peak) + 1);
    return glm::clamp(glm::mix(color, Vec3(new_peak), g), Vec3(0), Vec3(1));
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
    DisplayFramelet out;
    out.tile = framelet.tile;
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        Vec3 const display = tone_map(Vec3(framelet.red[i], framelet.green[i], framelet.blue[i]) * exposure);
        out.red[i] = srgb_byte_from_linear(display.r);
        out.green[i] = srgb_byte_from_linear(display.g);
        out.blue[i] = srgb_byte_from_linear(display.b);
    }
    return out;
}

} // namespace framelet
