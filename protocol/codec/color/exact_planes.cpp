#include "protocol/codec/color/exact_planes.h"

namespace framelet {
namespace {

/// Morton index of the first sample of each pair of neighbours in a row, the pairs in raster order. It is in an even
/// column, so the second one follows it in Morton order.
constexpr std::array<std::uint8_t, framelet_samples / 2> make_first_of_pair() {
    std::array<std::uint8_t, framelet_samples / 2> table{};
    for (std::uint32_t pair = 0; pair < table.size(); ++pair) {
        table[pair] = static_cast<std::uint8_t>(morton_index(2 * pair % framelet_side, 2 * pair / framelet_side));
    }
    return table;
}
constexpr auto first_of_pair = make_first_of_pair();

} // namespace

void difference(std::array<std::uint8_t, framelet_samples> const& samples, std::uint8_t* out) {
    std::uint8_t above = 0;
    for (std::size_t row = 0; row < framelet_samples; row += framelet_side) {
        std::uint8_t previous = above;
        above = samples[first_of_pair[row / 2]];
        for (std::size_t i = row; i < row + framelet_side; i += 2) {
            std::uint8_t const* const pair = &samples[first_of_pair[i / 2]];
            std::uint8_t const left = pair[0], right = pair[1];
            out[i] = static_cast<std::uint8_t>(left - previous);
            out[i + 1] = static_cast<std::uint8_t>(right - left);
            previous = right;
        }
    }
}

void undo_difference(std::uint8_t const* in, std::array<std::uint8_t, framelet_samples>& samples) {
    std::uint8_t above = 0;
    for (std::size_t row = 0; row < framelet_samples; row += framelet_side) {
        std::uint8_t previous = above;
        for (std::size_t i = row; i < row + framelet_side; i += 2) {
            std::size_t const first = first_of_pair[i / 2];
            samples[first] = static_cast<std::uint8_t>(previous + in[i]);
            samples[first + 1] = static_cast<std::uint8_t>(samples[first] + in[i + 1]);
            previous = samples[first + 1];
        }
        above = samples[first_of_pair[row / 2]];
    }
}

} // namespace framelet
