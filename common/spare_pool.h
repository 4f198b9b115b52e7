// The newest so many framelets that show nothing in their own places any more. In: framelets as they leave their
// places. Out: which of them have to go for good.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/tile.h"

namespace framelet {

/// A framelet that is kept besides what shows.
struct Spare {
    std::uint64_t batch = 0;
    Tile tile{0};
    std::int32_t slot = 0; ///< the cache's
};

/// Holds those of the highest batch numbers, of one batch those of the highest tile codes, whatever the order in which
/// they came.
class SparePool {
public:
    explicit SparePool(std::size_t most);

    /// Returns what has to go for it, itself perhaps. Allocates nothing; O(log n).
    std::optional<Spare> add(Spare const& spare);
    void clear() { spares_.clear(); }

    std::span<Spare const> all() const { return spares_; }
    std::size_t memory_bytes() const { return spares_.capacity() * sizeof(Spare); }

private:
    std::size_t most_;
    std::vector<Spare> spares_; ///< a heap, the oldest first
};

} // namespace framelet
