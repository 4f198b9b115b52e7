#include "common/held/shown_times.h"

#include <algorithm>
#include <cstddef>

namespace framelet {

namespace {

constexpr int side = FrameletCache::block_side;

struct Sum {
    double area = 0;
    double times = 0;
};

/// Adds what shows of a tile; `above` is the newest framelet that covers all of it.
void add_tile(FrameletCache const& cache, int depth, int column, int row, CachedFramelet const* above, double area,
              Sum& sum) {
    CachedFramelet const* const own = cache.find(depth, column, row);
    CachedFramelet const* const newest =
        own != nullptr && (above == nullptr || own->moment.batch >= above->moment.batch) ? own : above;
    if (depth < cache.finest_depth()) {
        for (int i = 0; i < 4; ++i) {
            add_tile(cache, depth + 1, 2 * column + i % 2, 2 * row + i / 2, newest, area / 4, sum);
        }
    } else if (newest != nullptr) {
        sum.area += area;
        sum.times += area * newest->moment.scene_time;
    }
}

std::optional<SceneTime> time_of_block(FrameletCache const& cache, int column, int row) {
    Sum sum;
    add_tile(cache, cache.plane().pixel_depth(), column, row, cache.newest_over(column, row), 1, sum);
    return sum.area > 0 ? std::optional(sum.times / sum.area) : std::nullopt;
}

/// Calls `visit(column, row, time)` with the blocks of which a rectangle has pixels in the viewport, and their times.
template <class Visit>
void for_each_block(PixelRect const& rect, Viewport viewport, ShownTimes& times, Visit const& visit) {
    auto const columns = static_cast<std::size_t>((viewport.width + side - 1) / side);
    for (int row = rect.top / side; row * side < std::min(rect.bottom, viewport.height); ++row) {
        for (int column = rect.left / side; column * side < std::min(rect.right, viewport.width); ++column) {
            visit(column, row, times[static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column)]);
        }
    }
}

} // namespace

void add_later_times(FrameletCache const& cache, ShownTimes& times) {
    ImagePlane const& plane = cache.plane();
    for (std::size_t slot = 0; slot < cache.slot_count(); ++slot) {
        CachedFramelet const* const framelet = cache.at_slot(slot);
        if (framelet == nullptr) {
            continue;
        }
        SceneTime const own = framelet->moment.scene_time;
        for_each_block(plane.tile_rect(framelet->tile), plane.viewport(), times,
                       [own](int, int, std::optional<SceneTime>& time) { time = std::max(time.value_or(own), own); });
    }
}

void update_shown_times(FrameletCache const& cache, std::span<PixelRect const> changed, ShownTimes& times) {
    Viewport const viewport = cache.plane().viewport();
    int const columns = (viewport.width + side - 1) / side;
    int const rows = (viewport.height + side - 1) / side;
    auto const update = [&](PixelRect const& rect) {
        for_each_block(rect, viewport, times, [&](int column, int row, std::optional<SceneTime>& time) {
            time = time_of_block(cache, column, row);
        });
    };
    auto const blocks = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    if (times.size() != blocks) {
        times.assign(blocks, std::nullopt);
        update({0, 0, viewport.width, viewport.height});
        return;
    }
    for (PixelRect const& rect : changed) {
        update(rect);
    }
}

} // namespace framelet
