// The standard views along the world's axes. glTF's scenes look towards +Z, and up is +Y.
#pragma once

#include <array>

#include "common/math.h"

namespace framelet {

struct AxisView {
    Vec3 forward, up;
    char const* name;
};

inline constexpr std::array<AxisView, 6> axis_views{{
    {{0, 0, -1}, {0, 1, 0}, "from the front"},
    {{0, 0, 1}, {0, 1, 0}, "from behind"},
    {{-1, 0, 0}, {0, 1, 0}, "from the right"},
    {{1, 0, 0}, {0, 1, 0}, "from the left"},
    {{0, -1, 0}, {0, 0, -1}, "from above"},
    {{0, 1, 0}, {0, 0, 1}, "from below"},
}};

} // namespace framelet
