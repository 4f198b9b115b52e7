// Chooses how a framelet with loss is predicted: not at all, from its own tile in the reference picture, or from
// elsewhere because it has moved. In: framelet, picture. Out: the cheapest way, and the residual to be coded.
#pragma once

#include <cstdint>

#include "protocol/codec/color/haar_planes.h"
#include "protocol/codec/color/motion_search.h"
#include "protocol/codec/color/reference_picture.h"

namespace framelet {

/// Kind of prediction, numbered as on the wire.
enum class PredictionKind : std::uint8_t { intra = 0, colocated = 1, displaced = 2 };

struct Prediction {
    PredictionKind kind = PredictionKind::intra;
    MotionVector vector; ///< zero where it has not moved
    DisplayFramelet samples; ///< the predicted ones; not set for `intra`
};

/// Chooses the prediction of a framelet, and returns the levels of its residual at this QP, 1..coarsest_qp.
HaarLevels predict(ReferencePicture const& reference, DisplayFramelet const& framelet, std::uint8_t qp,
                   MotionSearch& search, Prediction& prediction);

} // namespace framelet
