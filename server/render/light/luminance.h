// One number for a colour of light. In: linear Rec.709.
#pragma once

#include <glm/geometric.hpp>

#include "common/math.h"

namespace framelet {

/// Luminance, as in ITU-R BT.709.
inline float luminance(Vec3 const& color) {
    return glm::dot(color, Vec3(0.2126f, 0.7152f, 0.0722f));
}

/// Mean over the colours.
inline float mean(Vec3 const& color) {
    return (color.r + color.g + color.b) * (1.0f / 3.0f);
}

} // namespace framelet
