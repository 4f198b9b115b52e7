#include "common/hole_fill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "common/color.h"
#include "common/patch_sampling.h"
#include "common/reconstruction.h"

namespace framelet {

namespace {

constexpr int block_side = WarpedBlock::side;

/// What is so much nearer than the farthest of its neighbours does not spread: a share and, for the sky, 1 / metres.
constexpr float foreground_share = 1.15f;
constexpr float foreground_least = 1e-4f;

/// n x n cells in rows.
template <int n>
struct Grid {
    static constexpr std::size_t cells = static_cast<std::size_t>(n * n);
    alignas(64) std::array<float, cells> red, green, blue, inverse_depth;

    FarMean mean(std::size_t i) const { return {red[i], green[i], blue[i], inverse_depth[i]}; }
    void put(std::size_t i, FarMean const& mean) {
        red[i] = mean.red;
        green[i] = mean.green;
        blue[i] = mean.blue;
        inverse_depth[i] = mean.inverse_depth;
    }
};

/// The weighted mean of those of four that are about as far as the farthest.
struct FarthestOfFour {
    std::array<float, 4> take;
    float scale;
    float farthest;

    FarthestOfFour(std::array<float, 4> const& weights, float a, float b, float c, float d)
        : farthest(std::min(std::min(a, b), std::min(c, d))) {
        float const limit = farthest * foreground_share + foreground_least;
        take = {a <= limit ? weights[0] : 0.0f, b <= limit ? weights[1] : 0.0f, c <= limit ? weights[2] : 0.0f,
                d <= limit ? weights[3] : 0.0f};
        scale = 1 / (take[0] + take[1] + take[2] + take[3]);
    }
    float mean(float a, float b, float c, float d) const {
        return scale * ((take[0] * a + take[1] * b) + (take[2] * c + take[3] * d));
    }
};

/// The weighted mean of those of four that there are: over large squares the farthest one would be the sky.
FarMean known_mean(std::array<float, 4> const& weights, std::array<FarMean const*, 4> const& means) {
    FarMean sum{0, 0, 0, 0};
    float total = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        FarMean const& mean = *means[i];
        float const weight = mean.inverse_depth >= FarMean::nothing ? 0.0f : weights[i];
        sum.red += weight * mean.red;
        sum.green += weight * mean.green;
        sum.blue += weight * mean.blue;
        sum.inverse_depth += weight * (weight > 0 ? mean.inverse_depth : 0.0f);
        total += weight;
    }
    float const scale = 1 / total;
    return total > 0 ? FarMean{scale * sum.red, scale * sum.green, scale * sum.blue, scale * sum.inverse_depth}
                     : FarMean{};
}

template <int n>
void pull(Grid<2 * n> const& fine, Grid<n>& coarse) {
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            auto const to = static_cast<std::size_t>(y * n + x);
            auto const from = static_cast<std::size_t>(4 * y * n + 2 * x);
            std::size_t const below = from + 2 * n;
            FarthestOfFour const four({1, 1, 1, 1}, fine.inverse_depth[from], fine.inverse_depth[from + 1],
                                      fine.inverse_depth[below], fine.inverse_depth[below + 1]);
            coarse.red[to] = four.mean(fine.red[from], fine.red[from + 1], fine.red[below], fine.red[below + 1]);
            coarse.green[to] =
                four.mean(fine.green[from], fine.green[from + 1], fine.green[below], fine.green[below + 1]);
            coarse.blue[to] = four.mean(fine.blue[from], fine.blue[from + 1], fine.blue[below], fine.blue[below + 1]);
            coarse.inverse_depth[to] = four.farthest;
        }
    }
}

bool is_nothing(float inverse_depth) {
    return inverse_depth >= FarMean::nothing;
}

/// Cells of a coarse row, one for each of the n cells of a finer one.
template <int n>
struct Row {
    alignas(64) std::array<float, static_cast<std::size_t>(n)> red, green, blue, inverse_depth;

    template <int m, class Column>
    Row(Grid<m> const& coarse, int row, Column const& column) {
        for (int x = 0; x < n; ++x) {
            auto const from = static_cast<std::size_t>(row * m + column(x));
            auto const to = static_cast<std::size_t>(x);
            red[to] = coarse.red[from];
            green[to] = coarse.green[from];
            blue[to] = coarse.blue[from];
            inverse_depth[to] = coarse.inverse_depth[from];
        }
    }
};

/// Gives fine cells with nothing in them a value: interpolated between those of the four coarse cells around them that
/// are about as far as the farthest. What is still nothing (no picture at all) stays nothing. `parent` and `other` are
/// the coarse column (or row) that a fine one lies in and the nearest other one. Cells within the margin are not
/// needed. (No branch depends on a cell: eight are worked on at a time.)
template <int margin, int n, int m, class Parent, class Other>
void push(Grid<m> const& coarse, Grid<n>& fine, Parent const& parent, Other const& other) {
    for (int y = margin; y < n - margin; ++y) {
        Row<n> const own(coarse, parent(y), parent), beside(coarse, parent(y), other);
        Row<n> const above(coarse, other(y), parent), across(coarse, other(y), other);
        for (std::size_t x = margin; x < n - margin; ++x) {
            FarthestOfFour const four({9, 3, 3, 1}, own.inverse_depth[x], beside.inverse_depth[x],
                                      above.inverse_depth[x], across.inverse_depth[x]);
            std::size_t const to = static_cast<std::size_t>(y * n) + x;
            float const there = fine.inverse_depth[to];
            bool const nothing = is_nothing(there);
            float const red = four.mean(own.red[x], beside.red[x], above.red[x], across.red[x]);
            float const green = four.mean(own.green[x], beside.green[x], above.green[x], across.green[x]);
            float const blue = four.mean(own.blue[x], beside.blue[x], above.blue[x], across.blue[x]);
            fine.red[to] = nothing ? red : fine.red[to];
            fine.green[to] = nothing ? green : fine.green[to];
            fine.blue[to] = nothing ? blue : fine.blue[to];
            fine.inverse_depth[to] = nothing ? four.farthest : there;
        }
    }
}

template <int margin, int n>
void push(Grid<n / 2> const& coarse, Grid<n>& fine) {
    push<margin>(
        coarse, fine, [](int i) { return i / 2; },
        [](int i) { return std::clamp(i / 2 + (i % 2 == 0 ? -1 : 1), 0, n / 2 - 1); });
}

/// Pixels around a block, half a block more on each side.
void read_window(std::span<float const> inverse_depth, Picture const& picture, int left, int top, Grid<32>& window) {
    for (auto* const plane : {&window.red, &window.green, &window.blue}) {
        plane->fill(0);
    }
    window.inverse_depth.fill(FarMean::nothing);
    int const first = std::max(-left, 0);
    int const last = std::min(32, picture.width - left);
    for (int y = std::max(-top, 0); y < std::min(32, picture.height - top); ++y) {
        std::size_t const from = static_cast<std::size_t>(top + y) * static_cast<std::size_t>(picture.width) +
                                 static_cast<std::size_t>(left + first);
        alignas(64) std::array<std::uint32_t, 32> colors{};
        alignas(64) std::array<float, 32> depths;
        depths.fill(hole_depth);
        auto const count = static_cast<std::size_t>(last - first);
        auto const start = static_cast<std::size_t>(first);
        std::memcpy(&colors[start], picture.rgba.data() + 4 * from, 4 * count);
        std::memcpy(&depths[start], inverse_depth.data() + from, 4 * count);
        auto const to = static_cast<std::size_t>(y * 32);
        for (std::size_t x = 0; x < 32; ++x) {
            bool const shows = depths[x] > hole_depth;
            std::uint32_t const color = shows ? colors[x] : 0u;
            window.red[to + x] = square(red_of(color));
            window.green[to + x] = square(green_of(color));
            window.blue[to + x] = square(blue_of(color));
            window.inverse_depth[to + x] = shows ? depths[x] : FarMean::nothing;
        }
    }
}

std::uint32_t byte_of(float square) {
    return static_cast<std::uint32_t>(
        static_cast<std::int32_t>(std::min(std::sqrt(std::max(square, 0.0f)) + 0.5f, 255.0f)));
}

} // namespace

FarMean far_mean(WarpedBlock const& block) {
    Grid<4> fours;
    if (block.holes == 0) {
        for (int y = 0; y < 4; ++y) {
            for (int x = 0; x < 4; ++x) {
                auto const from = static_cast<std::size_t>((4 * y + 1) * block_side + 4 * x + 1);
                bool const shows = block.inverse_depth[from] > hole_depth; // it may be outside of the viewport
                fours.put(static_cast<std::size_t>(y * 4 + x),
                          shows ? FarMean{block.squares[0][from], block.squares[1][from], block.squares[2][from],
                                          block.inverse_depth[from]}
                                : FarMean{});
            }
        }
    } else {
        Grid<16> whole;
        whole.red = block.squares[0];
        whole.green = block.squares[1];
        whole.blue = block.squares[2];
        for (std::size_t i = 0; i < WarpedBlock::pixels; ++i) {
            whole.inverse_depth[i] = block.inverse_depth[i] > hole_depth ? block.inverse_depth[i] : FarMean::nothing;
        }
        Grid<8> eights;
        pull(whole, eights);
        pull(eights, fours);
    }
    Grid<2> twos;
    Grid<1> one;
    pull(fours, twos);
    pull(twos, one);
    return one.mean(0);
}

FarMean const& FarMeans::Level::at(int column, int row) const {
    auto const x = static_cast<std::size_t>(std::clamp(column, 0, columns - 1));
    auto const y = static_cast<std::size_t>(std::clamp(row, 0, rows - 1));
    return means[y * static_cast<std::size_t>(columns) + x];
}

FarMean const& FarMeans::at(int column, int row) const {
    return levels_.front().at(column, row);
}

void FarMeans::pull(Level const& fine, Level& coarse) const {
    coarse.columns = (fine.columns + 1) / 2;
    coarse.rows = (fine.rows + 1) / 2;
    coarse.means.clear();
    for (int y = 0; y < fine.rows; y += 2) {
        for (int x = 0; x < fine.columns; x += 2) {
            coarse.means.push_back(known_mean(
                {1, 1, 1, 1}, {&fine.at(x, y), &fine.at(x + 1, y), &fine.at(x, y + 1), &fine.at(x + 1, y + 1)}));
        }
    }
}

void FarMeans::push(Level const& coarse, Level& fine) const {
    std::size_t i = 0;
    for (int y = 0; y < fine.rows; ++y) {
        for (int x = 0; x < fine.columns; ++x, ++i) {
            if (is_nothing(fine.means[i].inverse_depth)) {
                int const beside = x / 2 + (x % 2 == 0 ? -1 : 1);
                int const above = y / 2 + (y % 2 == 0 ? -1 : 1);
                fine.means[i] = known_mean({9, 3, 3, 1}, {&coarse.at(x / 2, y / 2), &coarse.at(beside, y / 2),
                                                          &coarse.at(x / 2, above), &coarse.at(beside, above)});
            }
        }
    }
}

void FarMeans::make(std::span<FarMean const> blocks, int columns, int rows) {
    std::size_t count = 1;
    for (int side = std::max(columns, rows); side > 1; side = (side + 1) / 2) {
        ++count;
    }
    levels_.resize(count);
    levels_[0].columns = columns;
    levels_[0].rows = rows;
    levels_[0].means.assign(blocks.begin(), blocks.end());
    for (std::size_t i = 1; i < count; ++i) {
        pull(levels_[i - 1], levels_[i]);
    }
    for (std::size_t i = count - 1; i > 0; --i) {
        push(levels_[i], levels_[i - 1]);
    }
}

void fill_holes(FarMeans const& means, std::span<float const> inverse_depth, int column, int row, Picture& picture) {
    Grid<32> pixels;
    Grid<16> twos;
    Grid<8> fours;
    Grid<4> eights;
    Grid<3> blocks;
    int const left = column * block_side;
    int const top = row * block_side;
    read_window(inverse_depth, picture, left - block_side / 2, top - block_side / 2, pixels);
    pull(pixels, twos);
    pull(twos, fours);
    pull(fours, eights);
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 3; ++x) {
            blocks.put(static_cast<std::size_t>(y * 3 + x), means.at(column + x - 1, row + y - 1));
        }
    }
    push<0>(
        blocks, eights, [](int i) { return (i + 1) / 2; }, [](int i) { return (i + 1) / 2 + (i % 2 == 0 ? 1 : -1); });
    push<1>(eights, fours);
    push<3>(fours, twos);
    push<block_side / 2>(twos, pixels);
    std::uint32_t const gray = srgb_byte_from_linear(uncovered_light);
    std::uint32_t const uncovered = picture_pixel(gray, gray, gray);
    int const width = std::min(block_side, picture.width - left);
    for (int y = 0; y < std::min(block_side, picture.height - top); ++y) {
        auto const window = static_cast<std::size_t>((y + block_side / 2) * 32 + block_side / 2);
        std::array<std::uint32_t, block_side> colors;
        for (std::size_t x = 0; x < block_side; ++x) {
            FarMean const mean = pixels.mean(window + x);
            std::uint32_t const color = picture_pixel(byte_of(mean.red), byte_of(mean.green), byte_of(mean.blue));
            colors[x] = is_nothing(mean.inverse_depth) ? uncovered : color;
        }
        float const* const depth =
            inverse_depth.data() + static_cast<std::size_t>(top + y) * static_cast<std::size_t>(picture.width) + left;
        std::uint8_t* const pixel = picture.row(top + y) + 4 * left;
        for (int x = 0; x < width; ++x) {
            if (!(depth[x] > hole_depth)) {
                std::memcpy(pixel + 4 * x, &colors[static_cast<std::size_t>(x)], sizeof colors[0]);
            }
        }
    }
}

} // namespace framelet
