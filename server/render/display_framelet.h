// Turns a rendered framelet into what the viewer gets. In: radiance. Out: display samples, a byte for each colour.
#pragma once

#include "common/color.h"
#include "common/framelet/framelet.h"

namespace framelet {

/// The framelet exposed, tone-mapped and sRGB-encoded.
DisplayFramelet to_display(Framelet const& framelet, DisplayTransform const& transform);

} // namespace framelet
