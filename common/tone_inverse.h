// What a tone curve shows as a given colour.
#pragma once

#include "common/color.h"

namespace framelet {

/// The radiance that the curve shows as this colour. In: linear Rec.709 colour, >= 0. `neutral` shows nothing finite as
/// white, and pure colours less bright: what is brighter than 0.98 comes out as that, 2 steps of 255 below white, and a
/// colour that is too pure as bright as it can be. Film shows all colours as film does: for `aces` and `agx` it is the
/// colour itself, as for `linear`. Out: >= 0, finite.
Vec3 radiance_shown_as(Vec3 shown, ToneCurve curve);

} // namespace framelet
