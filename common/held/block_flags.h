// Says as rectangles which 16x16 blocks of a picture changed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet/tile.h"

namespace framelet {

/// Replaces `rects` by runs of the blocks whose flag (a byte each, in rows of `columns`) is 1, and clears the flags:
/// disjoint, each one block high (fewer pixels at the viewport's lower edge), rows from the top.
inline void take_flagged(std::span<std::uint8_t> flags, int columns, Viewport viewport, std::vector<PixelRect>& rects) {
    constexpr int side = framelet_side;
    rects.clear();
    int top = 0;
    for (auto row = flags.begin(); row != flags.end(); row += columns, top += side) {
        auto const end = row + columns;
        for (auto first = std::find(row, end, 1); first != end;) {
            auto const last = std::find(first, end, 0);
            std::fill(first, last, std::uint8_t{0});
            rects.push_back({static_cast<int>(first - row) * side, top,
                             std::min(static_cast<int>(last - row) * side, viewport.width),
                             std::min(top + side, viewport.height)});
            first = std::find(last, end, 1);
        }
    }
}

} // namespace framelet
