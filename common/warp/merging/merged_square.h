// Merges neighbouring framelets where their layers are about one plane: the rim of each costs as much as its middle
// when they move, and those finer than pixels are hardly more than rim. In: what is held in a square of 8x8 tiles. Out:
// its samples in one grid, which of them are merged, and what is left. None of this depends on the camera that shows
// it, so it is kept as long as what is held stays.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/held/framelet_cache.h"
#include "common/warp/merging/coplanar_merging.h"
#include "common/warp/merging/square_layers.h"

namespace framelet {

/// Layers of neighbouring framelets that are about one plane, as one layer of a larger framelet; or a single layer that
/// is merged with none.
struct MergedLayer {
    Tile tile; ///< the framelet's, the quad's or the square that all of them are in
    Tile first; ///< that of one of their framelets
    std::uint32_t first_layer = 0; ///< the number of that framelet's layer among them
    std::uint32_t view = 0; ///< the same for all of them
    HeldLayer layer; ///< pixels, columns and rows are from the corner of `tile`
    float difference = 0; ///< largest difference of the plane from theirs, 1 / metres; part of the layer's error
    std::int32_t side = 0; ///< samples along a side of `tile`
    std::int32_t stride = 0; ///< samples from one of their rows to the next
    PackedSample const* grid = nullptr;
    std::uint32_t number = 0; ///< the number of its samples in the grid, instead of a layer's
    LayerSet ends_before{}; ///< as in `WarpPatch`
    std::uint64_t newest_batch = 0;
    DecorrelationCode decorrelation = 0; ///< the soonest of theirs
    std::uint64_t signature = 0; ///< differs where what is held differs
    /// Bit p of word k is set for layer k of the framelet of index p, as in `SquareLayers`.
    std::array<std::uint64_t, max_layers> parts{};
    std::uint64_t occupied = 0; ///< as in `WarpPatch`
};

/// Framelets of one depth below a larger tile.
class MergedSquare {
public:
    /// Levels from the framelets up to the square; fewer where the quadtree has fewer.
    static constexpr int most_levels = SquareLayers::most_levels;
    static_assert(most_levels == SquareVersions::levels);
    static constexpr std::size_t most_children = SquareLayers::most_framelets;

    /// The framelet that is held for a tile.
    struct Child {
        CachedFramelet const* framelet = nullptr;
        std::array<std::uint8_t, max_layers> numbers{}; ///< of its layers in the grid
        bool is_written = false; ///< its samples are in the grid
    };

    /// Brings the square up to date; cache, square and depth are always the same ones. Looks at what has changed since
    /// the last call only; allocates where more is held or merged than ever before. `merging` is scratch.
    void update(FrameletCache const& cache, Tile square, int depth, CoplanarMerging& merging);

    /// The framelets of that depth below the square, by index (as in `SquareLayers`); empty where nothing ever was
    /// held. This and what follows is valid until the next update.
    std::span<Child const> children() const { return children_; }
    /// True when nothing is held of the square now.
    bool is_empty() const {
        return std::ranges::all_of(children_, [](Child const& child) { return child.framelet == nullptr; });
    }
    /// The layers that those of the framelets were merged into; each of theirs is part of one of these.
    std::span<MergedLayer const> merged() const { return merged_; }
    /// Quads, of four framelets each, which are part of one of `merged()`.
    std::span<CoplanarLayers const> quads() const { return quads_; }
    /// Makes one layer of layers that were merged, or of a quad.
    MergedLayer merge(CoplanarLayers const& coplanar) const;
    Tile child_tile(std::size_t index) const;
    /// All samples of the square in rows, `side()` by `side()`; empty where nothing ever was held.
    std::span<PackedSample const> grid() const { return grid_; }
    int side() const { return side_; } ///< samples along a side of the grid
    int child_side() const { return child_side_; } ///< samples along a side of a child's part of the grid
    struct GridPosition {
        int column = 0, row = 0;
    };
    /// The position of a sample of this grid; nothing where it is another grid's.
    std::optional<GridPosition> position_in_grid(PackedSample const* sample) const;
    /// The position of a child's first sample.
    GridPosition position_of_child(std::size_t index) const;
    /// A bit for each child whose samples have been written since this was called last; all of them where the grid is
    /// new.
    std::uint64_t take_written() { return std::exchange(written_, 0); }
    /// Bit i: child i has outliers.
    std::uint64_t children_with_outliers() const { return with_outliers_; }

private:
    int levels() const { return depth_ - square_.depth(); } ///< of the children below the square
    std::uint64_t changes(SquareVersions const& versions) const;
    void load(FrameletCache const& cache, std::uint64_t changed);
    void make_room(ImagePlane const& plane);
    bool set_layers(std::uint64_t children);
    void keep(CoplanarMerging const& merging);
    Tile tile_around(std::array<std::uint64_t, max_layers> const& parts) const;
    void set_tile(CoplanarLayers const& coplanar, Tile tile, MergedLayer& out) const;
    std::uint64_t occupied_parts(std::array<std::uint64_t, max_layers> const& parts, Tile tile) const;
    void find_ends();
    std::size_t offset_of(std::size_t index) const;
    void write(Child const& child, PackedSample* to) const;
    template <int side>
    void write_samples(Child const& child, PackedSample* to) const;

    Tile square_;
    int depth_ = 0;
    double spacing_ = 0; ///< of the grid's samples, pixels
    int child_side_ = 0; ///< samples along a side of a framelet's grid
    int side_ = 0; ///< samples along a side of the grid
    SquareVersions versions_; ///< the versions that it is up to date with
    std::vector<Child> children_;
    std::unique_ptr<SquareLayers> layers_;
    std::vector<MergedLayer> merged_;
    std::vector<CoplanarLayers> quads_;
    std::uint64_t with_outliers_ = 0; ///< a bit for each child
    std::vector<PackedSample> grid_; ///< of the square, in rows
    std::uint64_t written_ = 0; ///< a bit for each child
};

} // namespace framelet
