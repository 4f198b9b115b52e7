#include "common/color.h"

#include <cmath>

namespace framelet {

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

float display_luma(Vec3 radiance, float exposure) {
    Vec3 const shown = tone_map(radiance * exposure);
    return display_luma(srgb_byte_from_linear(shown.r), srgb_byte_from_linear(shown.g), srgb_byte_from_linear(shown.b));
}

} // namespace framelet
