#include "common/framelet/reprojection.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

namespace framelet {

namespace {

/// Smallest share of its area that a plane may keep in front of the display camera: less is edge-on.
constexpr double thinnest = 1e-6;

glm::dmat3 directions(ViewRays const& rays) {
    return {glm::dvec3(rays.direction_dx), glm::dvec3(rays.direction_dy), glm::dvec3(rays.direction)};
}

} // namespace

ViewTransform make_view_transform(ViewRays const& source, ViewRays const& display, Motion const& motion,
                                  glm::dvec3 drift) {
    glm::dmat3 const to_display = glm::inverse(directions(display));
    glm::dvec3 const origin = motion.linear * glm::dvec3(source.origin) + motion.offset + drift;
    return {to_display * (motion.linear * directions(source)), to_display * (origin - glm::dvec3(display.origin))};
}

glm::dmat3 make_stretch(Layer const& layer, ViewRays const& display, glm::dvec2 middle, glm::dvec3 dx, glm::dvec3 dy) {
    glm::dmat3 const to_display =
        (layer.at + layer.dx * middle.x + layer.dy * middle.y) * glm::inverse(directions(display));
    return {to_display * dx, to_display * dy, to_display * (-middle.x * dx - middle.y * dy)};
}

std::optional<PlaneTransform> make_plane_transform(ViewTransform const& view, Layer const& layer,
                                                   glm::dvec2 tile_corner, glm::dmat3 const& stretch) {
    glm::dvec3 const plane(layer.dx, layer.dy, layer.at); // inverse depth of (x, y, 1)
    PlaneTransform out;
    out.to_display = view.far + stretch;
    out.to_display[2] += tile_corner.x * view.far[0] + tile_corner.y * view.far[1];
    for (int column = 0; column < 3; ++column) {
        out.to_display[column] += plane[column] * view.parallax;
    }
    double const determinant = glm::determinant(out.to_display);
    if (!(determinant > thinnest * std::abs(glm::determinant(view.far)))) {
        return std::nullopt;
    }
    out.to_source = glm::inverse(out.to_display);
    out.inverse_depth = plane * out.to_source;
    return out;
}

PixelRect display_box(glm::dmat3 const& to_display, glm::dvec2 low, glm::dvec2 high, Viewport viewport) {
    std::array<glm::dvec3, 4> const corners{
        to_display * glm::dvec3(low.x, low.y, 1), to_display * glm::dvec3(high.x, low.y, 1),
        to_display * glm::dvec3(high.x, high.y, 1), to_display * glm::dvec3(low.x, high.y, 1)};
    glm::dvec2 least(INFINITY);
    glm::dvec2 most(-INFINITY);
    auto const include = [&](glm::dvec3 const& point) {
        glm::dvec2 const pixel = glm::dvec2(point) / point.z;
        least = glm::min(least, pixel);
        most = glm::max(most, pixel);
    };
    for (std::size_t i = 0; i < corners.size(); ++i) {
        glm::dvec3 const& a = corners[i];
        glm::dvec3 const& b = corners[(i + 1) % corners.size()];
        if (a.z >= nearest_share) {
            include(a);
        }
        if ((a.z >= nearest_share) != (b.z >= nearest_share)) {
            glm::dvec3 crossing = a + (nearest_share - a.z) / (b.z - a.z) * (b - a);
            crossing.z = nearest_share;
            include(crossing);
        }
    }
    auto const width = static_cast<double>(viewport.width);
    auto const height = static_cast<double>(viewport.height);
    if (!(least.x < width && least.y < height && most.x > 0 && most.y > 0)) {
        return {};
    }
    auto const first_centre_after = [](double value, double last) {
        return static_cast<int>(std::ceil(std::clamp(value - 0.5, 0.0, last)));
    };
    return {first_centre_after(least.x, width), first_centre_after(least.y, height), first_centre_after(most.x, width),
            first_centre_after(most.y, height)};
}

} // namespace framelet
