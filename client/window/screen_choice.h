// Decides which screen a window is on. In: where the window and the screens are, in the same coordinates. Out: the
// screen's number.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/framelet/tile.h"

namespace framelet {

/// The screen that has most of the window; 0, the main one, where none has any of it.
inline std::size_t screen_of(PixelRect const& window, std::span<PixelRect const> screens) {
    std::size_t best = 0;
    std::int64_t most = 0;
    for (std::size_t i = 0; i < screens.size(); ++i) {
        PixelRect const& screen = screens[i];
        std::int64_t const width = std::min(window.right, screen.right) - std::max(window.left, screen.left);
        std::int64_t const height = std::min(window.bottom, screen.bottom) - std::max(window.top, screen.top);
        std::int64_t const area = std::max<std::int64_t>(width, 0) * std::max<std::int64_t>(height, 0);
        if (area > most) {
            most = area;
            best = i;
        }
    }
    return best;
}

} // namespace framelet
