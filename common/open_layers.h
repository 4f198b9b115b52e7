// Layers that may be joined further: what of each is asked most, in rows, so that several are looked at at a time. In:
// planes and where they lie. Out: which of them are about a plane.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "common/lanes.h"
#include "common/plane_fit.h"

namespace framelet {

template <std::size_t most>
struct OpenLayers {
    static constexpr double taken = -1;
    /// A bit for each.
    using Bits = std::array<std::uint64_t, most / 64 + 1>;
    template <class T>
    using Row = std::array<T, most + wide_doubles>; ///< whole lanes are read

    void clear() { count = 0; }
    void add(std::size_t of_layer, double of_motion, std::uint8_t of_part, AffinePlane const& plane,
             PlaneExtent const& extent) {
        layer[count] = static_cast<std::int16_t>(of_layer);
        part[count] = of_part;
        motion[count] = of_motion;
        x[count] = extent.middle_x();
        y[count] = extent.middle_y();
        value[count] = plane(x[count], y[count]);
        ++count;
    }

    /// Of those from `first` on and before `last`, and maybe some around: of this motion, and in their middle no more
    /// than a share off the plane.
    Bits find(std::size_t first, std::size_t last, double of_motion, AffinePlane const& plane, double share) const {
        Bits out{};
        WideDoubles const zero{};
        AffineOf<WideDoubles> const lanes{zero + plane.at, zero + plane.dx, zero + plane.dy};
        auto const load = [](Row<double> const& row, std::size_t i) { return load_lanes<WideDoubles>(&row[i]); };
        for (std::size_t i = first / wide_doubles * wide_doubles; i < last; i += wide_doubles) {
            WideDoubles const inverse_depth = load(value, i);
            WideDoubles const apart = absolute(lanes(load(x, i), load(y, i)) - inverse_depth);
            out[i / 64] |= std::uint64_t{bits_of((load(motion, i) == of_motion) & (apart <= share * inverse_depth))}
                           << i % 64;
        }
        return out;
    }

    /// The first bit that is set from one on; `last` where there is none before.
    static std::size_t next(Bits const& bits, std::size_t from, std::size_t last) {
        constexpr std::uint64_t all = ~std::uint64_t{0};
        for (std::size_t word = from / 64; 64 * word < last; ++word) {
            std::uint64_t const left = bits[word] & (word == from / 64 ? all << from % 64 : all);
            if (left != 0) {
                return std::min(64 * word + static_cast<std::size_t>(std::countr_zero(left)), last);
            }
        }
        return last;
    }

    std::size_t count = 0;
    Row<std::int16_t> layer{};
    Row<std::uint8_t> part{}; ///< of the first framelet below it
    Row<double> motion{}; ///< the same for all of one view, body and velocity; `taken` when it has been joined
    Row<double> x{}, y{}, value{}; ///< its middle, and the inverse depth there
};

} // namespace framelet
