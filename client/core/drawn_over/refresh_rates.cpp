#include "client/core/drawn_over/refresh_rates.h"

#include <algorithm>
#include <cmath>

#include "client/core/drawn_over/age_colors.h"
#include "common/error.h"

namespace framelet {

namespace {

/// Seconds in which what has come counts for e times less.
constexpr double memory_seconds = 1;

void draw_cell(Picture& picture, int left, int top, float per_second) {
    bool const has_color = per_second >= RefreshRates::least;
    OverlayColor const color = age_color(
        has_color ? std::log(RefreshRates::most / per_second) / std::log(RefreshRates::most / RefreshRates::least) : 1);
    for (int y = top; y < std::min(top + RefreshRates::side, picture.height); ++y) {
        for (int x = left; x < std::min(left + RefreshRates::side, picture.width); ++x) {
            wash(picture.row(y) + 4 * static_cast<std::ptrdiff_t>(x), color, has_color ? usual_share : 0);
        }
    }
}

} // namespace

RefreshRates::RefreshRates(ImagePlane const& plane)
    : plane_(plane), columns_((plane.viewport().width + side - 1) / side),
      rows_((plane.viewport().height + side - 1) / side),
      rates_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

void RefreshRates::add(Batch const& batch) {
    for (DisplayFramelet const& framelet : batch.framelets) {
        PixelRect const rect = plane_.tile_rect(framelet.tile);
        float const width = static_cast<float>(std::min(rect.width(), side)) / side;
        auto const counted = static_cast<float>(static_cast<double>(width * width) / memory_seconds);
        for (int row = rect.top / side; row * side < rect.bottom && row < rows_; ++row) {
            for (int column = rect.left / side; column * side < rect.right && column < columns_; ++column) {
                rates_[index(column, row)] += counted;
            }
        }
    }
}

void RefreshRates::advance(double now) {
    double const elapsed = std::max(now - now_.value_or(now), 0.0);
    auto const kept = static_cast<float>(std::exp(-elapsed / memory_seconds));
    now_ = now;
    for (float& rate : rates_) {
        rate *= kept;
    }
}

bool RefreshRates::fades() const {
    return std::ranges::any_of(rates_, [](float rate) { return rate >= least; });
}

void RefreshRates::draw(Picture& picture) const {
    FRAMELET_CHECK(picture.width == plane_.viewport().width && picture.height == plane_.viewport().height);
    for (int row = 0; row < rows_; ++row) {
        for (int column = 0; column < columns_; ++column) {
            draw_cell(picture, column * side, row * side, per_second(column, row));
        }
    }
}

} // namespace framelet
