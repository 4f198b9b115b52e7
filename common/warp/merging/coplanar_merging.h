// Finds the layers of neighbouring framelets that lie on about one plane. In: the layers of a square. Out: planes, each
// with what is merged with it. None of this depends on the camera that shows it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/simd/lane_bits.h"
#include "common/warp/merging/piece_rows.h"
#include "common/warp/merging/plane_fit.h"
#include "common/warp/merging/square_layers.h"

namespace framelet {

/// The samples of a framelet: `side` x `side`, `spacing` pixels apart.
struct SampleGrid {
    int side = framelet_side;
    double spacing = 1;
};

/// A plane and the layers that were merged into it, or a single layer that is merged with none.
struct CoplanarLayers {
    AffinePlane plane; ///< inverse depth, pixels from the square's corner
    PlaneExtent extent; ///< of its samples, pixels from the square's corner
    double difference = 0; ///< largest difference of the plane from the merged layers, 1 / metres
    /// Bit p of word k is set for layer k of the framelet of index p, as in `SquareLayers`.
    std::array<std::uint64_t, max_layers> parts{};
};

/// Merges layers of a square that are of one view, body and velocity and of about one plane, where all of them together
/// are cheaper to show than each by itself. Greedily: what is found first may take what would suit others better.
class CoplanarMerging {
public:
    void merge(SquareLayers const& layers, SampleGrid const& grid);

    /// The planes that the layers were merged into; each layer is part of one of these.
    std::span<CoplanarLayers const> coplanar() const { return coplanar_; }
    /// The quads: four sibling framelets of one layer each, which all are part of one of `coplanar`.
    std::span<CoplanarLayers const> quads() const { return quads_; }

private:
    /// Largest number of pieces (quads and layers) that can be open: a quad replaces four layers.
    static constexpr std::size_t most_open = max_layers * SquareLayers::most_framelets;

    using Bits = LaneBits<most_open>; ///< of open pieces

    /// Pieces that are about to be merged.
    struct Group {
        Bits members;
        PlaneSums sums;
        AffinePlane plane;
        PlaneExtent extent;
        double difference = 0;
        double cost = 0; ///< of showing all together, pixels
        double cost_of_parts = 0;
    };

    void load(SquareLayers const& layers, std::size_t layer, SampleGrid const& grid);
    std::uint64_t merge_quads(std::uint64_t complete);
    void open(double share, double difference, std::size_t index, std::size_t layer);
    Group alone(std::size_t seed) const;
    Group grow(std::size_t seed, Bits const& open) const;
    bool extend(Bits some, bool near, Group& group, Bits& rest) const;
    Bits find(std::size_t seed, Group const& group, Bits const& open, bool near) const;
    void add(Bits const& added, Group& group) const;
    Bits fit(Group& group) const;
    CoplanarLayers layer_of(Group const& group) const;

    PieceRows<SquareLayers::most_framelets> loaded_; ///< one layer of each framelet
    // Open pieces, which are still to be merged: quads first, then layers.
    std::size_t quad_count_ = 0, open_count_ = 0;
    PieceRows<most_open> open_;
    /// Largest difference of each quad from its layers, 1 / metres, and as a share of its inverse depth there; 0 for
    /// layers.
    alignas(64) std::array<double, most_open> difference_{}, share_{};
    std::array<std::uint8_t, most_open> index_{}; ///< of the layer's framelet, or the quad's number
    std::array<std::uint8_t, most_open> layer_{};
    std::vector<CoplanarLayers> coplanar_, quads_;
};

} // namespace framelet
