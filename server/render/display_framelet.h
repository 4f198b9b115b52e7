// A rendered framelet in, what a viewer gets to see of it out.
#pragma once

#include "common/framelet/framelet.h"

namespace framelet {

/// Tone-mapped and sRGB-encoded. `exposure` multiplies radiance (2^EV).
DisplayFramelet to_display(Framelet const& framelet, float exposure);

} // namespace framelet
