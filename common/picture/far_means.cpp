#include "common/picture/far_means.h"

#include <algorithm>
#include <array>

namespace framelet {

namespace {

constexpr int block_side = WarpedBlock::side;

/// The weighted mean of those of four that there are: over large squares the farthest one would be the sky.
FarMean known_mean(std::array<float, 4> const& weights, std::array<FarMean const*, 4> const& means) {
    FarMean sum{0, 0, 0, 0};
    float total = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        FarMean const& mean = *means[i];
        float const weight = is_nothing(mean.inverse_depth) ? 0.0f : weights[i];
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

} // namespace

FarMean far_mean(WarpedBlock const& block) {
    FarGrid<4> level2;
    if (block.holes == 0) {
        // Columns 1, 5, 9, 13 of rows 1, 5, 9, 13, two rows at a time.
        auto const pick = [](std::array<float, WarpedBlock::pixels> const& plane, std::size_t row) {
            auto const odd_ones = [&](std::size_t y) {
                float const* const from = &plane[y * block_side];
                return odd_of(load_lanes(from), load_lanes(from + lane_count));
            };
            return even_of(odd_ones(row), odd_ones(row + 4));
        };
        FloatLanes const zero{};
        for (std::size_t half = 0; half < 2; ++half) {
            FloatLanes const depth = pick(block.inverse_depth, 8 * half + 1);
            IntLanes const shows = depth > hole_depth; // it may be outside of the viewport
            store_lanes(shows ? pick(block.squares[0], 8 * half + 1) : zero, &level2.red[8 * half]);
            store_lanes(shows ? pick(block.squares[1], 8 * half + 1) : zero, &level2.green[8 * half]);
            store_lanes(shows ? pick(block.squares[2], 8 * half + 1) : zero, &level2.blue[8 * half]);
            store_lanes(shows ? depth : zero + FarMean::nothing, &level2.inverse_depth[8 * half]);
        }
    } else {
        FarGrid<16> whole;
        whole.red = block.squares[0];
        whole.green = block.squares[1];
        whole.blue = block.squares[2];
        for (std::size_t i = 0; i < WarpedBlock::pixels; ++i) {
            whole.inverse_depth[i] = block.inverse_depth[i] > hole_depth ? block.inverse_depth[i] : FarMean::nothing;
        }
        FarGrid<8> level1;
        pull(whole, level1);
        pull(level1, level2);
    }
    FarGrid<2> level3;
    FarGrid<1> level4;
    pull(level2, level3);
    pull(level3, level4);
    return mean_at(level4, 0);
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

} // namespace framelet
