#include "common/picture/reconstruction.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <tbb/parallel_for.h>

#include "common/color.h"
#include "common/error.h"
#include "common/held/box_sums.h"

namespace framelet {

namespace {

constexpr int side = FrameletCache::block_side;
constexpr std::size_t row_stride = side; ///< of a block or a framelet in rows
constexpr int deepest_apron_levels = 2;

/// Pixels of one block, each as its four bytes lie in a picture.
using Block = std::array<std::uint32_t, row_stride * row_stride>;

struct LinearColor {
    float red = 0, green = 0, blue = 0;
};

/// Index in the table of bytes (`encoded`). Means and interpolations of table values stay in [0, 1].
std::int32_t step_of(float linear) {
    return static_cast<std::int32_t>(linear * TransferTables::steps +
                                     0.5f); // NOLINT(bugprone-incorrect-roundings): >= 0
}

std::uint32_t pixel_at(TransferTables const& tables, std::int32_t red, std::int32_t green, std::int32_t blue) {
    return picture_pixel(tables.encoded[static_cast<std::size_t>(red)], tables.encoded[static_cast<std::size_t>(green)],
                         tables.encoded[static_cast<std::size_t>(blue)]);
}

LinearColor sample_at(TransferTables const& tables, CachedFramelet const& framelet, int x, int y) {
    std::size_t const i = static_cast<std::size_t>(y) * row_stride + static_cast<std::size_t>(x);
    PackedSample const sample = framelet.samples[i];
    return {tables.linear[red_of(sample)], tables.linear[green_of(sample)], tables.linear[blue_of(sample)]};
}

/// The mean of n x n samples.
LinearColor mean_at(TransferTables const& tables, CachedFramelet const& framelet, int x, int y, int n) {
    LinearColor sum;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            LinearColor const s = sample_at(tables, framelet, x + i, y + j);
            sum.red += s.red;
            sum.green += s.green;
            sum.blue += s.blue;
        }
    }
    float const scale = 1.0f / static_cast<float>(n * n);
    return {sum.red * scale, sum.green * scale, sum.blue * scale};
}

/// Finds sample (x, y) of the sampling grid of one depth, counted over the whole image plane; false where no framelet
/// of this moment has it.
bool find_sample(TransferTables const& tables, FrameletCache const& cache, Moment const& moment, int depth, int x,
                 int y, LinearColor& out) {
    if (x < 0 || y < 0) {
        return false;
    }
    int const deepest = std::min(depth + deepest_apron_levels, cache.finest_depth());
    for (int d = depth; d <= deepest; ++d) {
        int const n = 1 << (d - depth);
        CachedFramelet const* const found = cache.find(d, x * n / side, y * n / side);
        if (found != nullptr && same_moment(found->moment, moment)) {
            out = mean_at(tables, *found, x * n % side, y * n % side, n);
            return true;
        }
    }
    return false;
}

/// The samples around a block that one coarse framelet covers: those inside and one beyond on each side. `spacing`
/// pixels between samples.
template <int spacing>
struct Neighbourhood {
    static constexpr int inside = side / spacing;
    static constexpr int across = inside + 2;
    std::array<std::array<std::array<float, across>, across>, 3> planes; ///< colour, row, column

    void put(int column, int row, LinearColor const& color) {
        auto const c = static_cast<std::size_t>(column);
        auto const r = static_cast<std::size_t>(row);
        planes[0][r][c] = color.red;
        planes[1][r][c] = color.green;
        planes[2][r][c] = color.blue;
    }
};

template <int spacing>
Neighbourhood<spacing> gather(TransferTables const& tables, FrameletCache const& cache, CachedFramelet const& framelet,
                              int block_column, int block_row) {
    using Samples = Neighbourhood<spacing>;
    Samples out;
    int const depth = framelet.tile.depth();
    int const left = static_cast<int>(framelet.tile.column()) * side; // of the framelet, in samples
    int const top = static_cast<int>(framelet.tile.row()) * side;
    int const x0 = block_column * Samples::inside - 1 - left; // of the neighbourhood, from the framelet
    int const y0 = block_row * Samples::inside - 1 - top;
    for (int row = 0; row < Samples::across; ++row) {
        for (int column = 0; column < Samples::across; ++column) {
            int const x = x0 + column;
            int const y = y0 + row;
            int const own_x = std::clamp(x, 0, side - 1);
            int const own_y = std::clamp(y, 0, side - 1);
            LinearColor color;
            bool const own = x == own_x && y == own_y;
            // Beyond a corner the neighbour beside comes before the own sample, so that both draw the same border.
            if (own || !(find_sample(tables, cache, framelet.moment, depth, left + x, top + y, color) ||
                         find_sample(tables, cache, framelet.moment, depth, left + x, top + own_y, color) ||
                         find_sample(tables, cache, framelet.moment, depth, left + own_x, top + y, color))) {
                color = sample_at(tables, framelet, own_x, own_y);
            }
            out.put(column, row, color);
        }
    }
    return out;
}

/// The samples of a neighbourhood between which the pixels of a block's row (or column) lie.
template <int spacing>
struct Taps {
    std::array<int, side> index{};
    std::array<float, side> weight{}; ///< of the sample after

    constexpr Taps() {
        for (int i = 0; i < side; ++i) {
            float const position =
                (static_cast<float>(i) + 0.5f) / spacing + 0.5f; // sample 0 is half a spacing outside
            index[static_cast<std::size_t>(i)] = static_cast<int>(position);
            weight[static_cast<std::size_t>(i)] = position - static_cast<float>(static_cast<int>(position));
        }
    }
};

template <int spacing>
void interpolate(TransferTables const& tables, Neighbourhood<spacing> const& samples, Block& block) {
    static constexpr Taps<spacing> taps;
    constexpr std::size_t across = Neighbourhood<spacing>::across;
    std::array<std::array<std::array<float, side>, across>, 3> wide; // as wide as the block, as high as the samples
    for (std::size_t color = 0; color < 3; ++color) {
        for (std::size_t row = 0; row < across; ++row) {
            auto const& from = samples.planes[color][row];
            for (std::size_t i = 0; i < side; ++i) {
                auto const at = static_cast<std::size_t>(taps.index[i]);
                wide[color][row][i] = from[at] + taps.weight[i] * (from[at + 1] - from[at]);
            }
        }
    }
    for (std::size_t y = 0; y < side; ++y) {
        auto const row = static_cast<std::size_t>(taps.index[y]);
        float const weight = taps.weight[y];
        std::array<std::array<std::int32_t, side>, 3> steps;
        for (std::size_t color = 0; color < 3; ++color) {
            auto const& above = wide[color][row];
            auto const& below = wide[color][row + 1];
            for (std::size_t i = 0; i < side; ++i) {
                steps[color][i] = step_of(above[i] + weight * (below[i] - above[i]));
            }
        }
        for (std::size_t i = 0; i < side; ++i) {
            block[y * side + i] = pixel_at(tables, steps[0][i], steps[1][i], steps[2][i]);
        }
    }
}

template <int spacing>
void paint_coarse(TransferTables const& tables, FrameletCache const& cache, CachedFramelet const& framelet, int column,
                  int row, Block& block) {
    interpolate(tables, gather<spacing>(tables, cache, framelet, column, row), block);
}

void paint_pixels(CachedFramelet const& framelet, Block& block) {
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        PackedSample const sample = framelet.samples[i];
        block[i] = picture_pixel(red_of(sample), green_of(sample), blue_of(sample));
    }
}

/// Decodes one colour of the samples to linear light. Out of line: inlined next to arithmetic, the table look-ups get
/// entangled in it by the vectoriser.
[[gnu::noinline]] void to_linear(TransferTables const& tables,
                                 std::array<PackedSample, framelet_samples> const& samples, std::size_t color,
                                 std::array<float, framelet_samples>& out) {
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        out[i] = tables.linear[samples[i] >> 8 * color & 255u];
    }
}

/// Paints a framelet of 2^levels x 2^levels samples a pixel, whose first pixel is (left, top) of the block.
template <int levels>
void paint_fine(TransferTables const& tables, CachedFramelet const& framelet, int left, int top, Block& block) {
    constexpr std::size_t n = 1 << levels;
    constexpr std::size_t pixels = side / n; // along a side
    constexpr float scale = 1.0f / (n * n);
    std::array<std::array<std::int32_t, pixels * pixels>, 3> steps;
    std::array<float, framelet_samples> linear;
    std::array<float, framelet_samples / 4> sums;
    for (std::size_t color = 0; color < 3; ++color) {
        to_linear(tables, framelet.samples, color, linear);
        box_sums(linear, n, sums);
        for (std::size_t i = 0; i < pixels * pixels; ++i) {
            steps[color][i] = step_of(sums[i] * scale);
        }
    }
    std::uint32_t* row = &block[static_cast<std::size_t>(top) * row_stride + static_cast<std::size_t>(left)];
    for (std::size_t y = 0; y < pixels; ++y, row += side) {
        for (std::size_t x = 0; x < pixels; ++x) {
            std::size_t const i = y * pixels + x;
            row[x] = pixel_at(tables, steps[0][i], steps[1][i], steps[2][i]);
        }
    }
}

void paint_uncovered(TransferTables const& tables, Block& block) {
    std::int32_t const step = step_of(uncovered_light);
    block.fill(pixel_at(tables, step, step, step));
}

void paint_block(TransferTables const& tables, FrameletCache const& cache, int column, int row, Block& block) {
    int const depth = cache.plane().pixel_depth();
    CachedFramelet const* const base = cache.newest_over(column, row);
    std::uint64_t const base_batch = base == nullptr ? 0 : base->moment.batch;
    if (base == nullptr) {
        paint_uncovered(tables, block);
    } else {
        switch (depth - base->tile.depth()) {
        case 0:
            paint_pixels(*base, block);
            break;
        case 1:
            paint_coarse<2>(tables, cache, *base, column, row, block);
            break;
        case 2:
            paint_coarse<4>(tables, cache, *base, column, row, block);
            break;
        default:
            paint_coarse<8>(tables, cache, *base, column, row, block);
        }
    }
    for (int quarter = 0; quarter < 4; ++quarter) {
        int const x = 2 * column + quarter % 2;
        int const y = 2 * row + quarter / 2;
        std::uint64_t shown = base_batch;
        CachedFramelet const* const half = cache.find(depth + 1, x, y);
        if (half != nullptr && half->moment.batch >= shown) {
            shown = half->moment.batch;
            paint_fine<1>(tables, *half, quarter % 2 * 8, quarter / 2 * 8, block);
        }
        for (int part = 0; part < 4; ++part) {
            CachedFramelet const* const fine = cache.find(depth + 2, 2 * x + part % 2, 2 * y + part / 2);
            if (fine != nullptr && fine->moment.batch >= shown) {
                paint_fine<2>(tables, *fine, quarter % 2 * 8 + part % 2 * 4, quarter / 2 * 8 + part / 2 * 4, block);
            }
        }
    }
}

void paint_block_row(TransferTables const& tables, FrameletCache const& cache, int first_column, int last_column,
                     int row, Picture& picture) {
    Block block;
    int const rows = std::min(side, picture.height - row * side);
    for (int column = first_column; column < last_column; ++column) {
        paint_block(tables, cache, column, row, block);
        auto const bytes = static_cast<std::size_t>(std::min(side, picture.width - column * side)) * sizeof block[0];
        for (int y = 0; y < rows; ++y) {
            std::memcpy(picture.row(row * side + y) + static_cast<std::size_t>(column) * side * 4,
                        &block[static_cast<std::size_t>(y) * side], bytes);
        }
    }
}

} // namespace

void reconstruct(FrameletCache const& cache, std::span<PixelRect const> changed, Picture& picture) {
    Viewport const viewport = cache.plane().viewport();
    FRAMELET_CHECK(picture.width == viewport.width && picture.height == viewport.height);
    TransferTables const& tables = transfer_tables();
    tbb::parallel_for(std::size_t{0}, changed.size(), [&](std::size_t i) {
        PixelRect const rect = changed[i];
        int const left = std::max(rect.left, 0) / side;
        int const right = (std::min(rect.right, viewport.width) + side - 1) / side;
        int const top = std::max(rect.top, 0) / side;
        int const bottom = (std::min(rect.bottom, viewport.height) + side - 1) / side;
        if (bottom - top == 1) {
            paint_block_row(tables, cache, left, right, top, picture);
        } else if (top < bottom) {
            tbb::parallel_for(top, bottom, [&](int row) { paint_block_row(tables, cache, left, right, row, picture); });
        }
    });
}

void reconstruct_block(FrameletCache const& cache, int column, int row, Picture& picture) {
    paint_block_row(transfer_tables(), cache, column, column + 1, row, picture);
}

void reconstruct_all(FrameletCache const& cache, Picture& picture) {
    Viewport const viewport = cache.plane().viewport();
    PixelRect const everything{0, 0, viewport.width, viewport.height};
    reconstruct(cache, std::span(&everything, 1), picture);
}

} // namespace framelet
