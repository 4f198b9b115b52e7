// How a framelet with loss is coded beside what the viewer holds: on its own, as the difference to what lies at its
// place, or to what lies elsewhere because it has moved. In: framelet, picture. Out: the cheapest way, and what is left
// to code.
#pragma once

#include <cstdint>

#include "protocol/damping.h"
#include "protocol/held_picture.h"
#include "protocol/vector_search.h"

namespace framelet {

enum class PredictionKind : std::uint8_t { none = 0, same_place = 1, moved = 2 };

struct Prediction {
    PredictionKind kind = PredictionKind::none;
    PictureVector vector; ///< zero where it has not moved
    Damping damping; ///< none where there is no prediction

    bool operator==(Prediction const&) const = default;
};

/// A prediction but for its vector as a byte of the wire, and back.
inline constexpr std::uint8_t largest_prediction_code = 2 * detail_choices * detail_choices;
std::uint8_t prediction_code(Prediction const& prediction);
/// `code` is at most `largest_prediction_code`.
Prediction prediction_of(std::uint8_t code);

/// Predicted values of a tile; `prediction` is not of kind `none`.
DisplayValues predicted_values(HeldPicture const& held, Tile tile, Prediction const& prediction);

/// Levels of what is left of the framelet at this quality, 1..coarsest_quality.
HaarLevels predict(HeldPicture const& held, DisplayFramelet const& framelet, std::uint8_t quality, VectorSearch& search,
                   Prediction& prediction);

} // namespace framelet
