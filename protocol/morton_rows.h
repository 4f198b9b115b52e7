// Samples from Morton order to rows and back, a block of 4x4 at a time: 16 neighbours in Morton order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "common/tile.h"

namespace framelet {

using SamplePlane = std::array<std::uint8_t, framelet_samples>;

namespace morton_block {
inline constexpr std::size_t side = 4, samples = 16;
using Samples [[gnu::vector_size(samples)]] = std::uint8_t;

/// Four rows to Morton order; the same swaps lead back.
inline Samples transposed(Samples block) {
    return __builtin_shufflevector(block, block, 0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15);
}

struct Place {
    std::uint8_t x, y;
};
/// Of each block of a framelet, its upper left sample.
constexpr auto make_places() {
    std::array<Place, framelet_samples / samples> places{};
    for (std::uint32_t block = 0; block < places.size(); ++block) {
        places[block] = {static_cast<std::uint8_t>(side * morton_x(block)),
                         static_cast<std::uint8_t>(side * morton_y(block))};
    }
    return places;
}
inline constexpr auto places = make_places();
} // namespace morton_block

/// `count` samples (16, 64 or 256) of a square whose rows are `stride` apart.
inline void from_rows(std::uint8_t const* rows, std::size_t stride, std::uint8_t* out,
                      std::size_t count = framelet_samples) {
    using namespace morton_block;
    for (std::size_t block = 0; block < count / samples; ++block) {
        std::uint8_t const* row = rows + places[block].y * stride + places[block].x;
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

inline void to_rows(std::uint8_t const* in, std::uint8_t* rows, std::size_t stride,
                    std::size_t count = framelet_samples) {
    using namespace morton_block;
    for (std::size_t block = 0; block < count / samples; ++block) {
        Samples values;
        std::memcpy(&values, in + block * samples, sizeof values);
        values = transposed(values);
        std::array<std::uint32_t, side> four;
        std::memcpy(four.data(), &values, sizeof values);
        std::uint8_t* row = rows + places[block].y * stride + places[block].x;
        for (std::uint32_t const part : four) {
            std::memcpy(row, &part, sizeof part);
            row += stride;
        }
    }
}

inline std::uint8_t mean_of_four(unsigned a, unsigned b, unsigned c, unsigned d) {
    return static_cast<std::uint8_t>((a + b + c + d + 2) >> 2);
}

/// Each value gets the mean of its four samples.
inline void put_means(SamplePlane const& samples, std::uint8_t* to, std::size_t stride) {
    std::array<std::uint8_t, framelet_samples / 4> means;
    for (std::size_t k = 0; k < means.size(); ++k) { // many at a time
        std::uint32_t four;
        std::memcpy(&four, &samples[4 * k], sizeof four);
        means[k] = mean_of_four(four & 255, four >> 8 & 255, four >> 16 & 255, four >> 24);
    }
    to_rows(means.data(), to, stride, means.size());
}

} // namespace framelet
