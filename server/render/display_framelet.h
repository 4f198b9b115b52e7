// Turns a rendered framelet into what the viewer gets. In: radiance. Out: display samples, a byte for each colour.
#pragma once

#include "common/framelet/framelet.h"

namespace framelet {

/// The framelet tone-mapped and sRGB-encoded; `exposure` multiplies radiance first (2^EV).
DisplayFramelet to_display(Framelet const& framelet, float exposure);

} // namespace framelet
