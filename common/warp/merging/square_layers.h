// The layers of the framelets of a square, in rows, so that several are looked at at a time. In: framelets that come
// and go. Out: rows of numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/held/held_shape.h"

namespace framelet {

/// Framelets of one depth below a larger tile, by index: four framelets of one parent make a quad; index i is quarter
/// i / 16 of quad i % 16, both in Morton order.
class SquareLayers {
public:
    static constexpr int most_levels = 3; ///< of framelets below the square
    static constexpr std::size_t most_quads = std::size_t{1} << 2 * (most_levels - 1);
    static constexpr std::size_t most_framelets = 4 * most_quads;
    static_assert(most_framelets == 64); // a bit each

    /// The index of a part of the square, whose number is in Morton order; `part_at` is the inverse.
    static constexpr std::size_t index_of(std::size_t part) { return part % 4 * most_quads + part / 4; }
    static constexpr std::size_t part_at(std::size_t index) { return index % most_quads * 4 + index / most_quads; }

    /// The body and drift of a layer, and the view from which it was seen.
    struct Motion {
        std::uint32_t view = 0;
        BodyNumber body = static_body;
        LayerDrift drift;

        bool operator==(Motion const&) const = default;
    };

    /// The first layers of all framelets, or their second or third ones.
    struct Rows {
        template <class T>
        using Row = std::array<T, most_framelets>;

        alignas(64) Row<float> at{}, dx{}, dy{}, error{}; ///< as in `Layer`
        Row<std::int32_t> box{}; ///< bytes as in `HeldLayer`, lowest first
        Row<std::int32_t> motion{}; ///< index into `motions`
        std::uint64_t held = 0; ///< a bit for each framelet of which some samples lie on such a layer
    };

    void clear(std::size_t index);
    /// Sets the layers of the framelet of that index. False where there are too many motions to number: then
    /// `forget_motions`, and set all of them anew.
    bool set(std::size_t index, std::uint32_t view, std::uint64_t batch, HeldShape const& shape);
    void forget_motions() { motions_.clear(); }

    Rows const& rows(std::size_t layer) const { return rows_[layer]; }
    Motion const& motion(std::int32_t index) const { return motions_[static_cast<std::size_t>(index)]; }
    std::uint64_t batch(std::size_t index) const { return batches_[index]; }

private:
    /// Largest number of motions that are numbered: more than there can be layers, so that where there are as many some
    /// of them are of no layer any more.
    static constexpr std::size_t most_motions = 4 * most_framelets;

    std::int32_t number_of(Motion const& motion);

    std::array<Rows, max_layers> rows_;
    Rows::Row<std::uint64_t> batches_{};
    std::vector<Motion> motions_;
    std::size_t last_motion_ = 0; ///< the one that was asked for last
};

} // namespace framelet
