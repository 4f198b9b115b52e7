// Neighbouring framelets as one where they show one plane: each one's rim costs what its middle costs when they move,
// and those finer than pixels are hardly more than rim. In: what is held in a square of 2x2 blocks. Out: their samples
// in one grid, and for the square and its parts the plane and how far it is from what they say. None of this depends on
// the camera that shows it, so it is kept as long as what is held stays.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/framelet_cache.h"

namespace framelet {

/// Neighbouring framelets that show about one plane, as one of `side` x `side` samples.
struct MergedFramelet {
    Tile tile; ///< that they are below
    Tile first; ///< of them; the others have its depth
    std::uint32_t view = 0; ///< of all of them
    HeldLayer layer; ///< the pixels are from the corner of `tile`
    float difference = 0; ///< largest one of the plane from theirs, 1 / metres; part of the layer's error
    std::int32_t side = 0;
    std::int32_t stride = 0; ///< of the grid's rows
    PackedSample const* grid = nullptr;
    std::uint64_t newest_batch = 0;
    std::uint64_t signature = 0; ///< differs where what is held differs
};

/// Framelets of one depth below a square of 2x2 blocks.
class FineSquare {
public:
    static constexpr std::uint32_t blocks = 4;

    /// Brings it up to date. `square` is one level above blocks; `depth` that of blocks or up to `finest_levels` more.
    /// Always of the same cache, square and depth. Looks at what has changed since the last call only; allocates the
    /// first time that something is held.
    void update(FrameletCache const& cache, Tile square, int depth);

    /// What is below part `index` (in Morton order) of the 4^levels parts of the square; null where not all of it is
    /// held, of one view, each framelet with a single layer on the same body. Valid until the next update.
    MergedFramelet const* merged(int levels, std::uint32_t index);

private:
    static constexpr int side = 2 * framelet_side; ///< of the grid

    struct Child {
        std::uint64_t version = 0; ///< 0 where none is held
        bool is_usable = false; ///< held, with a single layer
        std::uint32_t view = 0;
        std::uint64_t batch = 0;
        Layer layer;
    };
    enum class State : std::uint8_t { unknown, absent, present };
    struct Part {
        State state = State::unknown;
        MergedFramelet merged;
    };

    void load(FrameletCache const& cache, std::uint32_t block);
    void copy(CachedFramelet const& framelet, std::uint32_t index);
    bool make(int levels, std::uint32_t index, MergedFramelet& merged) const;

    Tile square_;
    int depth_ = 0;
    double pixels_ = 0; ///< along a child's side
    std::uint32_t usable_ = 0;
    std::array<std::uint64_t, blocks> versions_{};
    std::vector<Child> children_; ///< in Morton order
    std::vector<Part> parts_; ///< the square, its quarters, theirs
    std::vector<PackedSample> grid_; ///< of the square, in rows
};

} // namespace framelet
