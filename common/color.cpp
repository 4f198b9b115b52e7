#include "common/color.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/matrix.hpp>

#include "common/error.h"

namespace framelet {
namespace {

/// Rows as they are printed: glm takes columns.
Mat3 rows(Vec3 const& first, Vec3 const& second, Vec3 const& third) {
    return glm::transpose(Mat3(first, second, third));
}

/// The ACES reference rendering and output transforms, fitted ([Hill 2017]).
Vec3 aces(Vec3 const& linear) {
    static Mat3 const in = rows({0.59719f, 0.35458f, 0.04823f}, {0.07600f, 0.90834f, 0.01566f}, // to AP1, desaturated
                                {0.02840f, 0.13383f, 0.83777f});
    static Mat3 const out =
        rows({1.60475f, -0.53108f, -0.07367f}, {-0.10208f, 1.10813f, -0.00605f}, {-0.00327f, -0.07276f, 1.07602f});
    constexpr float brighter = 1 / 0.6f; // than the fit alone, as those who know it from the web expect
    constexpr float most = 1e4f; // white long before, and no square overflows
    Vec3 const v = in * glm::min(linear * brighter, most);
    return out * ((v * (v + 0.0245786f) - 0.000090537f) / (v * (0.983729f * v + 0.4329510f) + 0.238081f));
}

/// In the primaries of Rec.2020, moved inwards: log2, contrast, and back.
Vec3 agx(Vec3 const& linear) {
    static Mat3 const rec2020 =
        rows({0.6274f, 0.3293f, 0.0433f}, {0.0691f, 0.9195f, 0.0113f}, {0.0164f, 0.0880f, 0.8956f});
    static Mat3 const rec709 =
        rows({1.6605f, -0.5876f, -0.0728f}, {-0.1246f, 1.1329f, -0.0083f}, {-0.0182f, -0.1006f, 1.1187f});
    static Mat3 const inset =
        rows({0.856627153f, 0.0951212405f, 0.0482516061f}, {0.137318973f, 0.761241991f, 0.101439036f},
             {0.111898213f, 0.0767994186f, 0.811302368f});
    static Mat3 const outset =
        rows({1.12710058f, -0.110606643f, -0.0164939387f}, {-0.141329763f, 1.15782370f, -0.0164939387f},
             {-0.141329763f, -0.110606643f, 1.25193641f});
    static Mat3 const to = inset * rec2020, from = rec709 * outset;
    constexpr float least_stops = -12.47393f, most_stops = 4.026069f;
    Vec3 const stops = glm::log2(glm::max(to * glm::min(linear, 1e30f), 1e-10f));
    Vec3 const x = glm::clamp((stops - least_stops) / (most_stops - least_stops), 0.0f, 1.0f);
    Vec3 const x2 = x * x, x4 = x2 * x2;
    Vec3 const encoded =
        15.5f * x4 * x2 - 40.14f * x4 * x + 31.96f * x4 - 6.868f * x2 * x + 0.4298f * x2 + 0.1191f * x - 0.00232f;
    return from * glm::pow(glm::max(encoded, 0.0f), Vec3(2.2f));
}

} // namespace

Vec3 tone_map(Vec3 color) {
    tone_map(color.r, color.g, color.b);
    return color;
}

ToneCurve parse_tone_curve(std::string const& word) {
    constexpr std::array<char const*, 4> names{"neutral", "aces", "agx", "linear"};
    auto const found = std::ranges::find(names, word);
    if (found == names.end()) {
        throw InputError("a tone curve is neutral, aces, agx or linear, not '" + word + "'");
    }
    return static_cast<ToneCurve>(found - names.begin());
}

Vec3 tone_map(Vec3 linear, ToneCurve curve) {
    switch (curve) {
    case ToneCurve::aces:
        return glm::clamp(aces(linear), 0.0f, 1.0f);
    case ToneCurve::agx:
        return glm::clamp(agx(linear), 0.0f, 1.0f);
    case ToneCurve::linear:
        return glm::clamp(linear, 0.0f, 1.0f);
    default:
        return tone_map(linear);
    }
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

float display_luma(Vec3 radiance, DisplayTransform const& display) {
    Vec3 const shown = display.shown(radiance);
    return display_luma(srgb_byte_from_linear(shown.r), srgb_byte_from_linear(shown.g), srgb_byte_from_linear(shown.b));
}

} // namespace framelet
