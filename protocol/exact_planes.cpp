#include "protocol/exact_planes.h"

#include <cstring>

namespace framelet {
namespace {

/// Two samples that follow each other in Morton order lie beside each other in a row: where, in raster order.
constexpr std::array<std::uint8_t, framelet_samples / 2> make_raster_of_pair() {
    std::array<std::uint8_t, framelet_samples / 2> table{};
    for (std::uint32_t pair = 0; pair < table.size(); ++pair) {
        table[pair] = static_cast<std::uint8_t>(morton_y(2 * pair) * framelet_side + morton_x(2 * pair));
    }
    return table;
}
constexpr auto raster_of_pair = make_raster_of_pair();

} // namespace

void difference(std::array<std::uint8_t, framelet_samples> const& samples, std::uint8_t* out) {
    std::array<std::uint8_t, framelet_samples> raster;
    for (std::size_t pair = 0; pair < raster_of_pair.size(); ++pair) {
        std::memcpy(&raster[raster_of_pair[pair]], &samples[2 * pair], 2);
    }
    for (std::size_t row = 0; row < framelet_samples; row += framelet_side) {
        out[row] = static_cast<std::uint8_t>(raster[row] - (row > 0 ? raster[row - framelet_side] : 0));
        for (std::size_t i = row + 1; i < row + framelet_side; ++i) {
            out[i] = static_cast<std::uint8_t>(raster[i] - raster[i - 1]);
        }
    }
}

void undo_difference(std::uint8_t const* in, std::array<std::uint8_t, framelet_samples>& samples) {
    std::array<std::uint8_t, framelet_samples> raster;
    std::uint8_t above = 0;
    for (std::size_t row = 0; row < framelet_samples; row += framelet_side) {
        std::uint8_t previous = above;
        for (std::size_t i = row; i < row + framelet_side; ++i) {
            previous = static_cast<std::uint8_t>(previous + in[i]);
            raster[i] = previous;
        }
        above = raster[row];
    }
    for (std::size_t pair = 0; pair < raster_of_pair.size(); ++pair) {
        std::memcpy(&samples[2 * pair], &raster[raster_of_pair[pair]], 2);
    }
}

} // namespace framelet
