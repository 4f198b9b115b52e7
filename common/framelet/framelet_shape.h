// The shape of a framelet: where its samples lie in the world and what carries them, so that a viewer can show them
// from another camera at another time. A framelet is nearly always one or two planes, each on one rigid body: such a
// plane moves by one homography, and its depth costs a few bytes for all of its samples.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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

/// An angular rate as a code: 0 for 0, else 2^((code - 96) / 32) radians a second.
using SwingCode = std::uint8_t;

/// Radians a second of a code.
inline float swing_rate(SwingCode code) {
    return code == 0 ? 0.0f : std::exp2(static_cast<float>(code - 96) / 32);
}

/// The nearest code of a rate >= 0; 0 for what is slower than codes go, and for what is not a number.
inline SwingCode swing_code(float rate) {
    if (!(rate > 0.125f)) {
        return 0;
    }
    return static_cast<SwingCode>(std::lround(std::clamp(32 * std::log2(rate) + 96, 1.0f, 255.0f)));
}

/// How a sample goes on besides the motion of its body: of what deforms, and of a shadow that passes over what stands.
/// It swings or goes round, x'' = -rate^2 (x - middle): after s seconds of scene time, of either sign, it is
/// sin(rate s) / rate * velocity + (1 - cos(rate s)) / rate^2 * acceleration farther, metres in the world, and at most
/// jerk * |s|^3 / 6 metres off that. At rate 0 that is a parabola.
struct Drift {
    Vec3 velocity{0}; ///< metres a second
    Vec3 acceleration{0}; ///< metres a second squared
    float jerk = 0; ///< metres a second cubed, >= 0
    SwingCode swing = 0; ///< of the rate

    bool operator==(Drift const&) const = default;

    bool any() const { return velocity != Vec3(0) || acceleration != Vec3(0) || jerk != 0; }
    Vec3 after(float seconds) const {
        if (swing == 0) {
            return seconds * velocity + (0.5f * seconds * seconds) * acceleration;
        }
        float const rate = swing_rate(swing);
        float const half = std::sin(0.5f * rate * seconds) / rate;
        return (std::sin(rate * seconds) / rate) * velocity + (2 * half * half) * acceleration;
    }
};

/// The drift of a layer's samples, affine on the image plane: that at the tile's upper left corner, and what it changes
/// by a pixel to the right and down. The jerk is that of all samples.
struct LayerDrift {
    Drift corner;
    Vec3 velocity_dx{0}, velocity_dy{0};
    Vec3 acceleration_dx{0}, acceleration_dy{0};

    bool operator==(LayerDrift const&) const = default;

    bool any() const {
        return corner.any() || velocity_dx != Vec3(0) || velocity_dy != Vec3(0) || acceleration_dx != Vec3(0) ||
               acceleration_dy != Vec3(0);
    }
    /// The drift so many pixels from the corner.
    Drift at(Vec2 from_corner) const {
        return {corner.velocity + from_corner.x * velocity_dx + from_corner.y * velocity_dy,
                corner.acceleration + from_corner.x * acceleration_dx + from_corner.y * acceleration_dy, corner.jerk,
                corner.swing};
    }
};

/// A plane on one body. The inverse of the view depth (1 / metres, 0 at infinity) is affine on the image plane:
/// at + dx * (x - left) + dy * (y - top), where (x, y) is in pixels and (left, top) the tile's upper left corner.
struct Layer {
    float at = 0, dx = 0, dy = 0;
    float error = 0; ///< largest difference from the inverse depth of a sample that lies on it, 1 / metres
    BodyNumber body = static_body;
    LayerDrift drift;

    bool operator==(Layer const&) const = default;
};

/// A sample that lies on no layer.
struct Outlier {
    float inverse_depth = 0; ///< 1 / metres along the forward axis of the framelet's camera
    BodyNumber body = static_body;
    Drift drift;

    bool operator==(Outlier const&) const = default;
};

/// True when samples of this body and drift may be elsewhere at another time.
template <class AnyDrift>
bool moves(BodyNumber body, AnyDrift const& drift) {
    return body != static_body || drift.any();
}

struct FrameletShape {
    static constexpr std::uint8_t outlier = max_layers;

    std::uint8_t layer_count = 0;
    DecorrelationCode decorrelation = 0; ///< of what the framelet shows
    /// How its samples drift is known for so short a time that a newer framelet replaces it in its place, as if nothing
    /// moved.
    bool is_brief = false;
    std::array<Layer, max_layers> layers;
    /// The layer that each sample lies on, or `outlier`, in Morton order.
    std::array<std::uint8_t, framelet_samples> layer_of{};
    /// The samples whose layer is `outlier`, in Morton order.
    std::vector<Outlier> outliers;

    /// True when something in the framelet may be elsewhere at another time.
    bool moves() const {
        auto const one_moves = [](auto const& one) { return framelet::moves(one.body, one.drift); };
        return std::any_of(layers.begin(), layers.begin() + layer_count, one_moves) ||
               std::any_of(outliers.begin(), outliers.end(), one_moves);
    }

    bool operator==(FrameletShape const&) const = default;
};

} // namespace framelet
