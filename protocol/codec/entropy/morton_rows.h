// Moves samples from Morton order to rows and back, a block of 4x4 at a time: 16 neighbours in Morton order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "common/framelet/tile.h"

namespace framelet {

using SamplePlane = std::array<std::uint8_t, framelet_samples>;

namespace morton_block {
inline constexpr std::size_t side = 4, samples = 16;
using Samples [[gnu::vector_size(samples)]] = std::uint8_t;

/// Turns the four rows of a block into Morton order; the same swaps lead back.
inline Samples transposed(Samples block) {
    return __builtin_shufflevector(block, block, 0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15);
}

using Rows [[gnu::vector_size(samples)]] = std::uint32_t; ///< a row of a block in each lane

/// Turns four rows of 16 samples into four blocks side by side, each with its rows one after the other; the same leads
/// back.
inline void transpose(std::array<Rows, side>& rows) {
    auto const low = [](Rows const& a, Rows const& b) { return __builtin_shufflevector(a, b, 0, 4, 1, 5); };
    auto const high = [](Rows const& a, Rows const& b) { return __builtin_shufflevector(a, b, 2, 6, 3, 7); };
    Rows const ac_low = low(rows[0], rows[2]), ac_high = high(rows[0], rows[2]);
    Rows const bd_low = low(rows[1], rows[3]), bd_high = high(rows[1], rows[3]);
    rows = {low(ac_low, bd_low), high(ac_low, bd_low), low(ac_high, bd_high), high(ac_high, bd_high)};
}

/// Numbers in Morton order of the four blocks in a row of blocks.
inline std::array<std::size_t, side> blocks_of_row(std::size_t row) {
    std::size_t const first = 8 * (row / 2) + 2 * (row % 2);
    return {first, first + 1, first + 4, first + 5};
}
} // namespace morton_block

/// Turns the samples of a framelet, whose rows are `stride` apart, into Morton order.
inline void from_rows(std::uint8_t const* rows, std::size_t stride, std::uint8_t* out) {
    using namespace morton_block;
    for (std::size_t row = 0; row < side; ++row) {
        std::array<Rows, side> four;
        for (Rows& part : four) {
            std::memcpy(&part, rows, sizeof part);
            rows += stride;
        }
        transpose(four);
        auto const blocks = blocks_of_row(row);
        for (std::size_t i = 0; i < side; ++i) {
            auto const values = transposed(reinterpret_cast<Samples>(four[i]));
            std::memcpy(out + blocks[i] * samples, &values, sizeof values);
        }
    }
}

inline void to_rows(std::uint8_t const* in, std::uint8_t* rows, std::size_t stride) {
    using namespace morton_block;
    for (std::size_t row = 0; row < side; ++row) {
        std::array<Rows, side> four;
        auto const blocks = blocks_of_row(row);
        for (std::size_t i = 0; i < side; ++i) {
            Samples values;
            std::memcpy(&values, in + blocks[i] * samples, sizeof values);
            four[i] = reinterpret_cast<Rows>(transposed(values));
        }
        transpose(four);
        for (Rows const& part : four) {
            std::memcpy(rows, &part, sizeof part);
            rows += stride;
        }
    }
}

/// Does what `from_rows` does for a quarter of a framelet, 8x8.
inline void quarter_from_rows(std::uint8_t const* rows, std::size_t stride, std::uint8_t* out) {
    using namespace morton_block;
    for (std::size_t block = 0; block < 4; ++block) {
        std::uint8_t const* row = rows + block / 2 * side * stride + block % 2 * side;
        std::array<std::uint32_t, side> four;
        for (std::uint32_t& part : four) {
            std::memcpy(&part, row, sizeof part);
            row += stride;
        }
        Samples values;
        std::memcpy(&values, four.data(), sizeof values);
        values = transposed(values);
        std::memcpy(out + block * samples, &values, sizeof values);
    }
}

inline void quarter_to_rows(std::uint8_t const* in, std::uint8_t* rows, std::size_t stride) {
    using namespace morton_block;
    for (std::size_t block = 0; block < 4; ++block) {
        Samples values;
        std::memcpy(&values, in + block * samples, sizeof values);
        values = transposed(values);
        std::array<std::uint32_t, side> four;
        std::memcpy(four.data(), &values, sizeof values);
        std::uint8_t* row = rows + block / 2 * side * stride + block % 2 * side;
        for (std::uint32_t const part : four) {
            std::memcpy(row, &part, sizeof part);
            row += stride;
        }
    }
}

inline std::uint8_t mean_of_four(unsigned a, unsigned b, unsigned c, unsigned d) {
    return static_cast<std::uint8_t>((a + b + c + d + 2) >> 2);
}

/// Gives each of 8x8 values, in rows `stride` apart, the mean of its four samples.
inline void put_means(SamplePlane const& samples, std::uint8_t* to, std::size_t stride) {
    std::array<std::uint8_t, framelet_samples / 4> means;
    for (std::size_t k = 0; k < means.size(); ++k) { // many at a time
        std::uint32_t four;
        std::memcpy(&four, &samples[4 * k], sizeof four);
        means[k] = mean_of_four(four & 255, four >> 8 & 255, four >> 16 & 255, four >> 24);
    }
    quarter_to_rows(means.data(), to, stride);
}

} // namespace framelet
