// The shape of a framelet: where its samples lie in the world and what carries them, so that a viewer can show them
// from another camera at another time. A framelet is nearly always one or two planes, each on one rigid body: such a
// plane moves by one homography, and its depth costs a few bytes for all of its samples.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "common/framelet/tile.h"
#include "common/math.h"

namespace framelet {

/// The number of the body that carries a sample: 0 is what never moves; others are numbered by the server and have a
/// BodyTrack.
using BodyNumber = std::uint16_t;
inline constexpr BodyNumber static_body = 0;

/// Largest number of layers of a framelet, also on the wire.
inline constexpr std::size_t max_layers = 3;

/// A decorrelation rate as a code: how soon a surface looks otherwise than it did (a shadow passes, a light changes)
/// though it stays where it is. See `common/framelet/sample_worth.h`. 0: its looks do not change.
using DecorrelationCode = std::uint8_t;

/// A plane on one body. The inverse of the view depth (1 / metres, 0 at infinity) is affine on the image plane:
/// at + dx * (x - left) + dy * (y - top), where (x, y) is in pixels and (left, top) the tile's upper left corner.
struct Layer {
    float at = 0, dx = 0, dy = 0;
    float error = 0; ///< largest difference from the inverse depth of a sample that lies on it, 1 / metres
    BodyNumber body = static_body;
    /// Velocity besides the body's motion of what deforms and of a shadow that passes over the plane, metres a second
    /// in the world at the framelet's scene time; else 0.
    Vec3 velocity{0};

    bool operator==(Layer const&) const = default;
};

/// A sample that lies on no layer.
struct Outlier {
    float inverse_depth = 0; ///< 1 / metres along the forward axis of the framelet's camera
    BodyNumber body = static_body;
    Vec3 velocity{0}; ///< as that of a layer, metres a second

    bool operator==(Outlier const&) const = default;
};

/// True when a sample of this body and velocity may be elsewhere at another time.
inline bool moves(BodyNumber body, Vec3 const& velocity) {
    return body != static_body || velocity != Vec3(0);
}

struct FrameletShape {
    static constexpr std::uint8_t outlier = max_layers;

    std::uint8_t layer_count = 0;
    DecorrelationCode decorrelation = 0; ///< of what the framelet shows
    std::array<Layer, max_layers> layers;
    /// The layer that each sample lies on, or `outlier`, in Morton order.
    std::array<std::uint8_t, framelet_samples> layer_of{};
    /// The samples whose layer is `outlier`, in Morton order.
    std::vector<Outlier> outliers;

    /// True when something in the framelet may be elsewhere at another time.
    bool moves() const {
        auto const one_moves = [](auto const& one) { return framelet::moves(one.body, one.velocity); };
        return std::any_of(layers.begin(), layers.begin() + layer_count, one_moves) ||
               std::any_of(outliers.begin(), outliers.end(), one_moves);
    }

    bool operator==(FrameletShape const&) const = default;
};

} // namespace framelet
