#include "server/scene/assimp/polygon.h"

#include <numeric>

#include <glm/geometric.hpp>

namespace framelet {
namespace {

/// Twice the signed area of a triangle.
double area(glm::dvec2 const& a, glm::dvec2 const& b, glm::dvec2 const& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The corners in the plane they are about in, counter-clockwise: the axis is dropped along which the polygon's normal
/// (M. Newell's, the sum of the edges' cross products) is longest.
std::vector<glm::dvec2> flatten(std::span<Vec3 const> corners) {
    glm::dvec3 normal(0);
    glm::dvec3 const origin(corners[0]);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        normal += glm::cross(glm::dvec3(corners[i]) - origin, glm::dvec3(corners[(i + 1) % corners.size()]) - origin);
    }
    glm::dvec3 const size = glm::abs(normal);
    int const axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    std::vector<glm::dvec2> flat;
    for (Vec3 const& corner : corners) {
        glm::dvec3 const p = glm::dvec3(corner) - origin;
        double const u = p[(axis + 1) % 3];
        double const v = p[(axis + 2) % 3];
        flat.emplace_back(normal[axis] < 0 ? glm::dvec2(v, u) : glm::dvec2(u, v));
    }
    return flat;
}

} // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<Vec3 const> corners) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> left(corners.size());
    std::iota(left.begin(), left.end(), 0u);
    if (corners.size() > 3 && corners.size() <= max_clipped_corners) {
        std::vector<glm::dvec2> const flat = flatten(corners);
        auto const is_ear = [&](std::size_t i) {
            std::uint32_t const a = left[(i + left.size() - 1) % left.size()];
            std::uint32_t const b = left[i];
            std::uint32_t const c = left[(i + 1) % left.size()];
            if (!(area(flat[a], flat[b], flat[c]) > 0)) {
                return false;
            }
            for (std::uint32_t const other : left) {
                glm::dvec2 const p = flat[other];
                bool const corner = p == flat[a] || p == flat[b] || p == flat[c];
                if (!corner && area(flat[a], flat[b], p) >= 0 && area(flat[b], flat[c], p) >= 0 &&
                    area(flat[c], flat[a], p) >= 0) {
                    return false;
                }
            }
            return true;
        };
        std::size_t candidate = 1;
        std::size_t refused = 0;
        while (left.size() > 3 && refused < left.size()) {
            candidate %= left.size();
            if (is_ear(candidate)) {
                triangles.push_back({left[(candidate + left.size() - 1) % left.size()], left[candidate],
                                     left[(candidate + 1) % left.size()]});
                left.erase(left.begin() + static_cast<std::ptrdiff_t>(candidate));
                refused = 0;
            } else {
                ++refused;
            }
            ++candidate; // going round keeps the triangles from all meeting in one corner
        }
    }
    for (std::size_t i = 1; i + 1 < left.size(); ++i) {
        triangles.push_back({left[0], left[i], left[i + 1]});
    }
    return triangles;
}

} // namespace framelet
