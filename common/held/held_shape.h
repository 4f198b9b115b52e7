// The form in which a viewer holds what a framelet shows: colour and layer of each sample in one word, the layers with
// the box of their samples, the outliers. Framelets finer than pixels have a second grid of one sample a pixel, the
// moving grid, for when they move. In: what a batch brings. Out: arrays to read samples from.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/framelet/body_motion.h"
#include "common/framelet/framelet.h"
#include "common/framelet/framelet_shape.h"

namespace framelet {

/// A sample in one word. Bytes, lowest first: red, green, blue (sRGB-encoded), layer (or `FrameletShape::outlier`).
using PackedSample = std::uint32_t;

constexpr std::uint32_t red_of(PackedSample sample) {
    return sample & 255u;
}
constexpr std::uint32_t green_of(PackedSample sample) {
    return sample >> 8 & 255u;
}
constexpr std::uint32_t blue_of(PackedSample sample) {
    return sample >> 16 & 255u;
}
constexpr std::uint32_t layer_of(PackedSample sample) {
    return sample >> 24;
}

/// A bit for each number that samples of a grid may have instead of a layer's.
using LayerSet = std::array<std::uint32_t, 8>;

/// A layer and the columns and rows of the moving grid between which its samples lie, last ones included; empty
/// (`last_column` < `first_column`) where it has none.
struct HeldLayer {
    Layer layer;
    std::int8_t first_column = 0, first_row = 0, last_column = -1, last_row = -1;
    /// Bit k is set where samples of the framelet's layer k that lie beside its own are clearly farther, so that it
    /// ends there.
    std::uint8_t ends_before = 0;
};

/// An outlier of the moving grid.
struct HeldOutlier {
    Outlier sample;
    std::uint8_t index = 0; ///< in the grid, in rows
};

struct HeldShape {
    std::uint8_t layer_count = 0;
    /// Samples along a side of the moving grid: 16, or as many as the tile has pixels if it is finer than they are.
    std::uint8_t side = framelet_side;
    bool moves = false; ///< something in it is on a body or drifts
    bool is_brief = false; ///< as of `FrameletShape`
    DecorrelationCode decorrelation = 0;
    std::vector<HeldOutlier> outliers; ///< in the order of the moving grid's rows
    std::array<PackedSample, framelet_samples / 4> reduced; ///< the moving grid in rows where `side` is not 16
    std::array<HeldLayer, max_layers> layers;
};

/// True when all that a framelet shows, rendered at `from`, is in the same place at `to`.
bool is_in_place(HeldShape const& held, SceneTime from, SceneTime to, BodyMotions const& motions);

/// Fills `samples` (in rows) and `held`, whose memory is used again. Without a shape all is infinitely far. The tile
/// has `samples_per_pixel` samples along a pixel's side (1 if it is no finer than pixels); the moving grid then has the
/// mean, in linear light, of those samples of a pixel that lie on the layer most of them lie on.
void hold(DisplayFramelet const& framelet, FrameletShape const* shape, int samples_per_pixel,
          std::array<PackedSample, framelet_samples>& samples, HeldShape& held);

/// Sets `ends_before` of the layers. `spacing`: that of the moving grid, pixels.
void find_ends(double spacing, std::array<PackedSample, framelet_samples> const& samples, HeldShape& held);

} // namespace framelet
