// Lists what of something is marked. In: a mark for each. Out: their indices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace framelet {

/// Replaces `indices` by those at which `marks` is not 0, in order.
inline void list_marked(std::span<std::uint8_t const> marks, std::vector<std::size_t>& indices) {
    indices.clear();
    for (std::size_t i = 0; i < marks.size(); ++i) {
        if (marks[i] != 0) {
            indices.push_back(i);
        }
    }
}

} // namespace framelet
