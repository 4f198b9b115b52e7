#include "tests/evaluation/methods/response/depth_first_order.h"

#include <bit>

#include "common/error.h"

namespace framelet {

std::uint64_t subtree_size(std::uint32_t index, int max_depth) {
    int const depth = static_cast<int>(std::bit_width(index)) - 1;
    FRAMELET_CHECK(index != 0 && depth <= max_depth && max_depth < 63);
    return (std::uint64_t(1) << (max_depth - depth + 1)) - 1;
}

std::uint64_t depth_first_index(std::uint32_t index, int max_depth) {
    std::uint64_t number = 1;
    for (; index > 1; index /= 2) {
        number += 1 + (index % 2 == 1 ? subtree_size(index - 1, max_depth) : 0);
    }
    return number;
}

} // namespace framelet
