// Pieces of planes in rows, so that several are worked on at a time.
#pragma once

#include <array>
#include <cstddef>

#include "common/simd/lanes.h"
#include "common/warp/merging/plane_fit.h"

namespace framelet {

using PieceLanes = PieceOf<WideDoubles>;

/// `count` pieces, a multiple of `wide_doubles`.
template <std::size_t count>
struct PieceRows {
    using Row = std::array<double, count>;

    alignas(64) Row x{}, y{}, half_width{}, half_height{}, value{}, dx{}, dy{};
    Row motion{}; ///< a number, the same for what moves alike

    PlanePiece piece(std::size_t i) const {
        return {x[i], y[i], half_width[i], half_height[i], value[i], dx[i], dy[i]};
    }
    PieceLanes load(std::size_t i) const {
        auto const lanes = [i](Row const& row) { return load_lanes<WideDoubles>(&row[i]); };
        return {lanes(x), lanes(y), lanes(half_width), lanes(half_height), lanes(value), lanes(dx), lanes(dy)};
    }
    /// Loads pieces, whose numbers are 0 in lanes where `is` is 0.
    PieceLanes load(std::size_t i, WideLongs const& is) const {
        auto const lanes = [&](Row const& row) { return is ? load_lanes<WideDoubles>(&row[i]) : WideDoubles{}; };
        return {lanes(x), lanes(y), lanes(half_width), lanes(half_height), lanes(value), lanes(dx), lanes(dy)};
    }
    WideDoubles load_motion(std::size_t i) const { return load_lanes<WideDoubles>(&motion[i]); }
    void store(PieceLanes const& pieces, WideDoubles const& motions, std::size_t i) {
        store_lanes(pieces.x, &x[i]);
        store_lanes(pieces.y, &y[i]);
        store_lanes(pieces.half_width, &half_width[i]);
        store_lanes(pieces.half_height, &half_height[i]);
        store_lanes(pieces.value, &value[i]);
        store_lanes(pieces.dx, &dx[i]);
        store_lanes(pieces.dy, &dy[i]);
        store_lanes(motions, &motion[i]);
    }
    template <std::size_t from_count>
    void copy(PieceRows<from_count> const& from, std::size_t i, std::size_t to) {
        x[to] = from.x[i];
        y[to] = from.y[i];
        half_width[to] = from.half_width[i];
        half_height[to] = from.half_height[i];
        value[to] = from.value[i];
        dx[to] = from.dx[i];
        dy[to] = from.dy[i];
        motion[to] = from.motion[i];
    }
};

} // namespace framelet
