#include "server/scene/backdrop.h"

#include <algorithm>
#include <functional>

#include <glm/geometric.hpp>

namespace framelet {

namespace {

/// Least ground of what lies around the rest, in the rest's: twice as long and as wide.
constexpr float least_ground = 4;
/// Least diagonal of a sky that takes light, in those of the rest.
constexpr float least_lit_sky = 30;
/// A sky may leave out so much of what it holds, in its own height: the ground at its lower edge.
constexpr float slack = 0.01f;

float diagonal(Bounds const& box) {
    return glm::length(box.size());
}

/// The area seen from above, square metres.
float ground(Bounds const& box) {
    return box.size().x * box.size().z;
}

bool lies_around(Bounds const& outer, Bounds const& inner) {
    return outer.lower.x <= inner.lower.x && outer.lower.z <= inner.lower.z && outer.upper.x >= inner.upper.x &&
           outer.upper.z >= inner.upper.z;
}

bool holds(Bounds const& outer, Bounds const& inner) {
    float const room = slack * outer.size().y;
    return lies_around(outer, inner) && outer.lower.y - room <= inner.lower.y && outer.upper.y + room >= inner.upper.y;
}

} // namespace

Bounds without_backdrop(std::vector<ScenePart> parts) {
    std::ranges::stable_sort(parts, std::ranges::greater(), [](ScenePart const& part) { return diagonal(part.box); });
    std::vector<Bounds> from(parts.size() + 1); ///< of each part and all that are smaller
    for (std::size_t i = parts.size(); i > 0; --i) {
        from[i - 1] = from[i];
        from[i - 1].include(parts[i - 1].box.lower);
        from[i - 1].include(parts[i - 1].box.upper);
    }
    if (parts.size() < 2 || !holds(parts[0].box, from[1])) {
        return from[0];
    }
    std::size_t behind = 1; // so many parts are the backdrop's
    while (ground(parts[behind - 1].box) < least_ground * ground(from[behind])) {
        if (++behind == parts.size() || !lies_around(parts[behind - 1].box, from[behind])) {
            return from[0];
        }
    }
    Bounds const& rest = from[behind];
    bool const is_sky = !parts[0].takes_light && std::any_of(parts.begin() + 1, parts.end(),
                                                             [](ScenePart const& part) { return part.takes_light; });
    return is_sky || diagonal(parts[0].box) >= least_lit_sky * diagonal(rest) ? rest : from[0];
}

} // namespace framelet
