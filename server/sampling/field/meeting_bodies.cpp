#include "server/sampling/field/meeting_bodies.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "common/framelet/reprojection.h"

namespace framelet {
namespace {

constexpr SceneTime short_time = 1.0 / 60;
/// The largest number of points at which bodies meet that are looked at in one part of a framelet.
constexpr int most_meetings = 4;
constexpr double most_speed = 1e5;

/// Pixel to which the body that is seen at `pixel` carries it in `short_time`.
glm::dvec2 moved(RenderedMoment const& moment, BodyNumber body, Vec2 pixel, float depth) {
    Motion const motion = moment.motions->between(body, moment.scene_time, moment.scene_time + short_time);
    if (motion == Motion{}) {
        return pixel;
    }
    glm::dvec3 const to = make_view_transform(moment.rays, moment.rays, motion).map(pixel.x, pixel.y, 1.0 / depth);
    return to.z > 0 ? glm::dvec2(to) / to.z : glm::dvec2(pixel);
}

} // namespace

float meeting_speed(Framelet const& framelet, ImagePlane const& plane, RenderedMoment const& moment, std::size_t first,
                    std::size_t count) {
    if (framelet.body.empty() || moment.motions == nullptr) {
        return 0;
    }
    PixelRect const rect = plane.tile_rect(framelet.tile);
    float const spacing = plane.sample_spacing(framelet.tile);
    double most = 0;
    int meetings = 0;
    // Neighbours along the curve are neighbours in the picture, but for its few jumps.
    for (std::size_t i = first + 1; i < first + count && meetings < most_meetings; ++i) {
        BodyNumber const a = framelet.body[i - 1], b = framelet.body[i];
        if (a == b) {
            continue;
        }
        ++meetings;
        auto const sample = static_cast<std::uint32_t>(i);
        Vec2 const pixel = Vec2(rect.left, rect.top) + (Vec2(morton_x(sample), morton_y(sample)) + 0.5f) * spacing;
        double const apart =
            glm::distance(moved(moment, a, pixel, framelet.depth[i - 1]), moved(moment, b, pixel, framelet.depth[i]));
        most = std::max(most, apart / short_time); // NaN is not greater
    }
    return static_cast<float>(std::min(most, most_speed));
}

} // namespace framelet
