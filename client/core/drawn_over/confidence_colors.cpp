#include "client/core/drawn_over/confidence_colors.h"

#include <algorithm>
#include <cmath>

#include "client/core/drawn_over/age_colors.h"
#include "common/error.h"

namespace framelet {

namespace {

constexpr float youngest = 0.01f, oldest = 10; ///< seconds
constexpr OverlayColor made_up{255, 0, 255};
constexpr float coarsest = 8; ///< pixels between samples at which colours are darkest
constexpr float darkest = 0.4f;
constexpr float wash = 0.6f; ///< share of the colour

OverlayColor color_of(PixelConfidence const& pixel) {
    if (pixel.seconds == PixelConfidence::made_up) {
        return made_up;
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
    auto pixel = picture.rgba.begin();
    for (PixelConfidence const& shown : confidence) {
        OverlayColor const color = color_of(shown);
        auto const grey = static_cast<float>(pixel[0] + 2 * pixel[1] + pixel[2]) / 4;
        for (std::size_t i = 0; i < color.size(); ++i, ++pixel) {
            *pixel = static_cast<std::uint8_t>(std::lround((1 - wash) * grey + wash * color[i]));
        }
        ++pixel; // alpha
    }
}

} // namespace framelet
