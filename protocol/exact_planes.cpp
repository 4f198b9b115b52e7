#include "protocol/exact_planes.h"

namespace framelet {
namespace {

constexpr std::array<std::uint8_t, framelet_samples> make_morton_of_raster() {
    std::array<std::uint8_t, framelet_samples> table{};
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        table[i] = static_cast<std::uint8_t>(morton_index(i % framelet_side, i / framelet_side));
    }
    return table;
}
constexpr auto morton_of_raster = make_morton_of_raster();

} // namespace

void difference(std::array<std::uint8_t, framelet_samples> const& samples, std::uint8_t* out) {
    std::uint8_t above = 0;
    for (std::size_t row = 0; row < framelet_samples; row += framelet_side) {
        std::uint8_t previous = above;
        above = samples[morton_of_raster[row]];
        for (std::size_t i = row; i < row + framelet_side; ++i) {
            std::uint8_t const sample = samples[morton_of_raster[i]];
            out[i] = static_cast<std::uint8_t>(sample - previous);
            previous = sample;
        }
    }
}

void undo_difference(std::uint8_t const* in, std::array<std::uint8_t, framelet_samples>& samples) {
    std::uint8_t above = 0;
    for (std::size_t row = 0; row < framelet_samples; row += framelet_side) {
        std::uint8_t previous = above;
        for (std::size_t i = row; i < row + framelet_side; ++i) {
            previous = static_cast<std::uint8_t>(previous + in[i]);
            samples[morton_of_raster[i]] = previous;
        }
        above = samples[morton_of_raster[row]];
    }
}

} // namespace framelet
