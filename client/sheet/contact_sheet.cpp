#include "client/sheet/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "common/error.h"

namespace framelet {

namespace {

constexpr int gap = 8; ///< pixels between the pictures

void paste(Picture const& from, int left, int top, Picture& into) {
    for (int y = 0; y < from.height; ++y) {
        std::copy_n(from.row(y), 4 * from.width, into.row(top + y) + static_cast<std::ptrdiff_t>(4) * left);
    }
}

bool is_alike(Picture const& a, Picture const& b) {
    return a.width == b.width && a.height == b.height;
}

} // namespace

Picture contact_sheet(std::span<ShownAndStill const> pairs) {
    FRAMELET_CHECK(!pairs.empty());
    int const width = pairs.front().shown.width;
    int const height = pairs.front().shown.height;
    auto const columns = static_cast<int>(pairs.size());
    Picture out(columns * (width + gap) - gap, 2 * height + gap);
    std::ranges::fill(out.rgba, std::uint8_t{255});
    for (int i = 0; i < columns; ++i) {
        ShownAndStill const& pair = pairs[static_cast<std::size_t>(i)];
        FRAMELET_CHECK(is_alike(pair.shown, pairs.front().shown) && is_alike(pair.still, pair.shown));
        paste(pair.shown, i * (width + gap), 0, out);
        paste(pair.still, i * (width + gap), height + gap, out);
    }
    return out;
}

double mean_difference(Picture const& a, Picture const& b) {
    FRAMELET_CHECK(is_alike(a, b) && !a.rgba.empty());
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) { // the difference of alpha is 0
        sum += static_cast<std::uint64_t>(std::abs(a.rgba[i] - b.rgba[i]));
    }
    return static_cast<double>(sum) / (255.0 * 0.75 * static_cast<double>(a.rgba.size()));
}

} // namespace framelet
