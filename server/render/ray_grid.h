// Positions in a picture at equal distances, of which only some are looked at each time. In: spacing, how often they
// were looked at. Out: positions that were not looked at lately.
#pragma once

#include <cmath>
#include <cstdint>

#include "common/camera.h"
#include "common/math.h"

namespace framelet {

/// One such grid: its positions that lie in the picture, by column and row.
struct RayGrid {
    Vec2 first{0.5f}; ///< pixels, within the spacing
    int spacing = 1; ///< pixels

    int columns(Viewport viewport) const { return count(viewport.width, first.x); }
    int rows(Viewport viewport) const { return count(viewport.height, first.y); }
    Vec2 position(int column, int row) const { return first + static_cast<float>(spacing) * Vec2(column, row); }

private:
    int count(int pixels, float from) const {
        float const steps = std::ceil((static_cast<float>(pixels) - from) / static_cast<float>(spacing));
        return steps > 0 ? static_cast<int>(steps) : 0;
    }
};

/// The grid of the middles of cells of `cell` pixels, one in each square of `spacing` pixels (a power of two times as
/// large). Each `turn` takes another cell of the squares until all had theirs, far apart from one turn to the next.
inline RayGrid cell_grid(int cell, int spacing, std::uint32_t turn) {
    int x = 0, y = 0;
    for (int half = spacing / 2; half >= cell; half /= 2, turn >>= 2) {
        x += (turn & 1) != 0 ? half : 0;
        y += ((turn ^ turn >> 1) & 1) != 0 ? half : 0;
    }
    return {Vec2(x, y) + 0.5f * static_cast<float>(cell), spacing};
}

} // namespace framelet
