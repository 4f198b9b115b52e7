#include "client/core/drawn_over/confidence_colors.h"

#include <algorithm>
#include <cmath>

#include "client/core/drawn_over/age_colors.h"
#include "common/error.h"

namespace framelet {

namespace {

constexpr float youngest = 0.01f, oldest = 10; ///< seconds
constexpr float coarsest = 8; ///< pixels between samples at which colours are darkest
constexpr float darkest = 0.4f;

OverlayColor color_of(PixelConfidence const& pixel) {
    if (pixel.seconds == PixelConfidence::made_up) {
        return hole_color;
    }
    float const age = std::log2(std::max(pixel.seconds, youngest) / youngest) / std::log2(oldest / youngest);
    OverlayColor color = age_color(age);
    float const coarse = std::clamp(std::log2(std::max(pixel.spacing, 1.0f)) / std::log2(coarsest), 0.0f, 1.0f);
    for (float& value : color) {
        value *= 1 + coarse * (darkest - 1);
    }
    return color;
}

} // namespace

void draw_confidence(std::span<PixelConfidence const> confidence, Picture& picture) {
    FRAMELET_CHECK(confidence.size() ==
                   static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    std::uint8_t* pixel = picture.rgba.data();
    for (PixelConfidence const& shown : confidence) {
        wash(pixel, color_of(shown), usual_share);
        pixel += 4;
    }
}

} // namespace framelet
