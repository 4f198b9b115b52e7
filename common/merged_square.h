// Neighbouring framelets as one where their layers are about one plane: each one's rim costs what its middle costs when
// they move, and those finer than pixels are hardly more than rim. In: what is held in a square of 8x8 tiles. Out: its
// samples in one grid, what of them is joined, and what is left. None of this depends on the camera that shows it, so
// it is kept as long as what is held stays.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet_cache.h"
#include "common/layer_joining.h"

namespace framelet {

/// What something was joined of: nothing, a layer of a framelet or what was joined itself.
struct MergedPart {
    enum class Kind : std::uint8_t { nothing, layer, merged } kind = Kind::nothing;
    std::uint8_t layer = 0; ///< of the framelet
    std::uint16_t index = 0; ///< of the framelet among the square's, or in `MergedSquare::merged`
};

/// Layers of neighbouring framelets that are about one plane, as one layer of a larger framelet; or one of one framelet
/// that is joined to none.
struct MergedLayer {
    Tile tile; ///< that they are below
    Tile first; ///< of a framelet of theirs
    std::uint32_t first_layer = 0; ///< its layer
    std::uint32_t view = 0; ///< of all of them
    HeldLayer layer; ///< pixels, columns and rows are from the corner of `tile`
    float difference = 0; ///< at most: of the plane from theirs, 1 / metres; part of the layer's error
    std::int32_t side = 0; ///< of the samples in `tile`
    std::int32_t stride = 0; ///< from one of their rows to the next
    PackedSample const* grid = nullptr;
    std::uint32_t number = 0; ///< that its samples have in the grid, as it were a layer's
    std::uint64_t newest_batch = 0;
    std::uint64_t signature = 0; ///< differs where what is held differs
    std::array<MergedPart, 4> parts; ///< that it was joined of; none of one framelet's
};

/// Framelets of one depth below a larger tile.
class MergedSquare {
public:
    /// As many levels above framelets; less where there are less.
    static constexpr int most_levels = LayerJoining::most_levels;
    static_assert(most_levels == SquareVersions::levels);
    static constexpr std::uint32_t most_children = 1u << 2 * most_levels;
    static_assert(most_children <= 64); // a bit each

    /// What is held for a tile.
    struct Child {
        CachedFramelet const* framelet = nullptr;
        std::array<std::uint8_t, max_layers> numbers{}; ///< of its layers in the grid
        std::uint8_t layer_count = 0;
        bool has_loose = false;
        bool is_written = false; ///< to the grid
        // What joining needs of the framelet, which is far away in memory, besides its layers.
        std::uint32_t view = 0;
        std::uint64_t batch = 0;
    };

    /// Brings it up to date. Always of the same cache, square and depth. Looks at what has changed since the last call
    /// only; allocates where more is held or joined than ever before. `joining` is scratch.
    void update(FrameletCache const& cache, Tile square, int depth, LayerJoining& joining);

    /// What is below the square's tiles of that depth, in Morton order; empty where nothing ever was. This and what
    /// follows is valid until the next update.
    std::span<Child const> children() const { return children_; }
    /// All that could be joined, parts after what they were joined to; layers of framelets only where they are in none.
    std::span<MergedLayer const> merged() const { return merged_; }
    /// Which of these are joined no further.
    std::span<std::uint16_t const> tops() const { return tops_; }
    /// Bit i: child i has loose samples.
    std::uint64_t loose_children() const { return loose_children_; }

private:
    int levels() const { return depth_ - square_.depth(); } ///< of the children below the square
    std::uint64_t changes(SquareVersions const& versions);
    void load(FrameletCache const& cache, std::uint64_t changed);
    void make_room(ImagePlane const& plane);
    void copy_layers(std::size_t index);
    HeldLayer& layer(std::size_t child, std::size_t layer) { return layers_[layer * children_.size() + child]; }
    void join(LayerJoining& joining);
    void keep(std::span<JoinedLayer const> layers);
    void merge(JoinedLayer const& joined, MergedLayer& out) const;
    PackedSample* place_of(std::uint32_t index);
    void write(Child const& child, std::uint32_t index);
    template <int side>
    void write_samples(Child const& child, PackedSample* to) const;

    Tile square_;
    int depth_ = 0;
    double spacing_ = 0; ///< of its samples, pixels
    int child_side_ = 0; ///< of framelets' grids
    int side_ = 0; ///< of the grid
    SquareVersions versions_; ///< that it is up to date with
    std::vector<Child> children_;
    std::vector<HeldLayer> layers_; ///< copies: first ones of the children, then second ones, then third ones
    std::vector<MergedLayer> merged_;
    std::vector<std::uint16_t> tops_;
    std::uint64_t loose_children_ = 0;
    std::vector<PackedSample> grid_; ///< of the square, in rows
};

} // namespace framelet
