#include "server/schedule/picture_bound.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "common/reprojection.h"
#include "server/schedule/place_field.h"

namespace framelet {
namespace {

/// Of one framelet's part that are followed.
constexpr std::size_t most_followed = 4;
constexpr double most_speed = 1e5;
/// Depths a second: a camera that follows something goes slower, and one that was cut to another place follows nothing.
constexpr double most_following = 8;
/// A quarter of a display step, squared.
constexpr float noise = 1e-6f;
/// Of what the motion would have changed.
constexpr float least_share = 0.25f;

/// Otherwise nothing could be bound: a velocity is one of scene time.
bool has_passed(RenderedMoment const& moment) {
    return moment.seconds > 0 && moment.scene_time != moment.scene_time_before;
}

glm::dvec3 point_at(ViewRays const& rays, glm::dvec2 pixel, double depth) {
    glm::dvec3 const origin =
        glm::dvec3(rays.origin) + pixel.x * glm::dvec3(rays.origin_dx) + pixel.y * glm::dvec3(rays.origin_dy);
    glm::dvec3 const direction =
        glm::dvec3(rays.direction) + pixel.x * glm::dvec3(rays.direction_dx) + pixel.y * glm::dvec3(rays.direction_dy);
    return origin + depth * direction;
}

} // namespace

float carried_speed(Framelet const& framelet, ImagePlane const& plane, RenderedMoment const& moment, std::size_t first,
                    std::size_t count) {
    if (moment.motions == nullptr || !has_passed(moment)) {
        return 0;
    }
    PixelRect const rect = plane.tile_rect(framelet.tile);
    float const spacing = plane.sample_spacing(framelet.tile);
    std::size_t const step = std::max<std::size_t>(count / most_followed, 1);
    double sum = 0;
    int followed = 0;
    ViewTransform transform;
    std::optional<BodyNumber> carrier; // of the transform: samples are mostly on one body
    for (std::size_t i = first + step / 2; i < first + count; i += step) {
        BodyNumber const body = framelet.body.empty() ? static_body : framelet.body[i];
        if (carrier != body) {
            Motion const motion = moment.motions->between(body, moment.scene_time, moment.scene_time_before);
            transform = make_view_transform(moment.rays, moment.rays_before, motion);
            carrier = body;
        }
        auto const sample = static_cast<std::uint32_t>(i);
        Vec2 const pixel = Vec2(rect.left, rect.top) + (Vec2(morton_x(sample), morton_y(sample)) + 0.5f) * spacing;
        glm::dvec3 const before = transform.map(pixel.x, pixel.y, 1.0 / static_cast<double>(framelet.depth[i]));
        double const far = before.z > 0 ? glm::distance(glm::dvec2(before) / before.z, glm::dvec2(pixel)) : most_speed;
        double const speed = far / static_cast<double>(moment.seconds);
        sum += speed < most_speed ? speed : most_speed; // what is not a number is not less
        ++followed;
    }
    return static_cast<float>(sum / followed);
}

CarriedChange carried_change(PlaceModel const& model, Observation const& seen, float speed) {
    if (!seen.has_change) {
        return {};
    }
    float change = seen.mean_change;
    for (float const octave : seen.change) {
        change += octave;
    }
    return {change, drift_error(model, seen.level, drift_per_pixel * speed * seen.seconds)};
}

bool stays(CarriedChange const& change) {
    return change.expected > noise && change.seen < least_share * change.expected;
}

void bind_to_picture(Tile tile, ImagePlane const& plane, RenderedMoment const& moment, FrameletShape& shape) {
    if (!has_passed(moment)) {
        return;
    }
    double const seconds = moment.scene_time - moment.scene_time_before;
    PixelRect const rect = plane.tile_rect(tile);
    glm::dvec2 const middle = 0.5 * glm::dvec2(rect.width(), rect.height());
    auto const velocity_at = [&](glm::dvec2 from_corner, double inverse_depth) {
        glm::dvec2 const pixel = glm::dvec2(rect.left, rect.top) + from_corner;
        double const depth = 1 / inverse_depth;
        Vec3 const velocity((point_at(moment.rays, pixel, depth) - point_at(moment.rays_before, pixel, depth)) /
                            seconds);
        return static_cast<double>(glm::length(velocity)) < std::min(most_following * depth, most_speed) ? velocity
                                                                                                         : Vec3(0);
    };
    for (Layer& layer : std::span(shape.layers).first(shape.layer_count)) {
        if (layer.body == static_body && layer.velocity == Vec3(0)) {
            layer.velocity =
                velocity_at(middle, static_cast<double>(layer.at) + static_cast<double>(layer.dx) * middle.x +
                                        static_cast<double>(layer.dy) * middle.y);
        }
    }
    for (LooseSample& loose : shape.loose_samples) {
        if (loose.body == static_body && loose.velocity == Vec3(0)) {
            loose.velocity = velocity_at(middle, static_cast<double>(loose.inverse_depth));
        }
    }
}

} // namespace framelet
