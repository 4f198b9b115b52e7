// How a framelet with loss is coded beside what the viewer holds: on its own, as the difference to what lies at its
// place, or to what lies elsewhere because it has moved. In: framelet, picture. Out: the cheapest way, and what is left
// to code.
#pragma once

#include <cstdint>

#include "protocol/codec/color/haar_planes.h"
#include "protocol/codec/color/motion_search.h"
#include "protocol/codec/color/reference_picture.h"

namespace framelet {

/// As on the wire.
enum class PredictionKind : std::uint8_t { intra = 0, colocated = 1, displaced = 2 };

struct Prediction {
    PredictionKind kind = PredictionKind::intra;
    MotionVector vector; ///< zero where it has not moved
    DisplayFramelet samples; ///< predicted; only where there is a prediction
};

/// Levels of what is left of the framelet at this QP, 1..coarsest_qp.
HaarLevels predict(ReferencePicture const& reference, DisplayFramelet const& framelet, std::uint8_t qp,
                   MotionSearch& search, Prediction& prediction);

} // namespace framelet
