#include "server/render/display_framelet.h"

#include <array>

namespace framelet {

namespace {

using Steps = std::array<std::array<std::int32_t, framelet_samples>, 3>;

/// `curve` changes red, green and blue in place.
template <typename Curve>
void fill(Framelet const& framelet, float exposure, Curve curve, Steps& steps) {
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        float red = framelet.red[i] * exposure;
        float green = framelet.green[i] * exposure;
        float blue = framelet.blue[i] * exposure;
        curve(red, green, blue);
        steps[0][i] = static_cast<std::int32_t>(red * TransferTables::steps + 0.5f);
        steps[1][i] = static_cast<std::int32_t>(green * TransferTables::steps + 0.5f);
        steps[2][i] = static_cast<std::int32_t>(blue * TransferTables::steps + 0.5f);
    }
}

} // namespace

DisplayFramelet to_display(Framelet const& framelet, DisplayTransform const& transform) {
    Steps steps;
    if (transform.curve == ToneCurve::neutral) { // vector code
        auto const neutral = [](float& red, float& green, float& blue) { tone_map(red, green, blue); };
        fill(framelet, transform.exposure, neutral, steps);
    } else {
        auto const other = [&transform](float& red, float& green, float& blue) {
            Vec3 const shown = tone_map(Vec3(red, green, blue), transform.curve);
            red = shown.r;
            green = shown.g;
            blue = shown.b;
        };
        fill(framelet, transform.exposure, other, steps);
    }
    DisplayFramelet out;
    out.tile = framelet.tile;
    // A copy: bytes written below might alias the original.
    std::uint8_t const* const encoded = transfer_tables().encoded.data();
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        out.red[i] = encoded[steps[0][i]];
        out.green[i] = encoded[steps[1][i]];
        out.blue[i] = encoded[steps[2][i]];
    }
    return out;
}

} // namespace framelet
