// Draws what the server knows of a viewer's picture, to be looked at ([Stephens 2011] fig. 3.4, 7.25). In: a field, the
// choices, the cut that follows from them. Out: a picture of the viewport's size, brighter where there is more.
#pragma once

#include <span>

#include "common/image.h"
#include "server/sampling/field/region_field.h"
#include "server/sampling/model/sampling_choice.h"

namespace framelet {

enum class FieldView {
    tiles, ///< outlines of the cut's tiles, inside them how often they are refreshed: 0.1 .. 60 times a second
    density, ///< samples a pixel, 1/64 .. 16
    error, ///< shown mean squared error, 1e-6 (60 dB) .. 0.25
    motion, ///< drift a second, 0.01 .. 64; black: stands still
};

/// Values are grey on a logarithmic scale. `choices`: one for every region of the field; `cut`: covers the viewport.
Picture draw_field(RegionField const& field, std::span<SamplingChoice const> choices, std::span<Patch const> cut,
                   FieldView view);

} // namespace framelet
