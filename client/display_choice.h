// How the scene is to look, as the command line of either viewer says it; what it does not say is up to the program. A
// value.
#pragma once

#include <optional>

#include "client/core/drawn_over/drawn_over.h"
#include "protocol/messages/message.h"

namespace framelet {

struct DisplayChoice {
    std::optional<float> exposure_ev; ///< as in ViewerSettings
    std::optional<double> lag_seconds; ///< as in `ClientCore::set_smoothing`
    bool unwarped = false; ///< every pixel stays where it was rendered
    DrawnOver drawn_over = DrawnOver::nothing;

    ViewerSettings settings() const { return {exposure_ev.value_or(0), 0, !unwarped}; }
};

} // namespace framelet
