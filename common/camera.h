// A camera, a viewport and the rays between them. Pixel coordinates: x right, y down, (0,0) is the upper left corner of
// the viewport, pixel (i,j) has its centre at (i+0.5, j+0.5).
#pragma once

#include <cstdint>

#include "common/math.h"

namespace framelet {

enum class Projection : std::uint8_t { perspective = 0, orthographic = 1 };

/// The bounds of a camera's numbers are far from where single precision overflows, and far above denormals, so that
/// every thread sees the same camera however it treats those.
inline constexpr float max_camera_coordinate = 1e10f; ///< metres, on each axis and side
inline constexpr float least_field_of_view = 1e-4f, most_field_of_view = 3.13f; ///< radians
inline constexpr float least_view_height = 1e-4f, most_view_height = 1e10f; ///< metres, orthographic

/// Pose and lens. In its own space a camera looks down -Z with +Y up (as in glTF).
struct Camera {
    Vec3 position{0, 0, 0}; ///< in the world, metres
    Quat orientation{1, 0, 0, 0}; ///< rotates camera space into world space; unit length
    Projection projection = Projection::perspective;
    float vertical_extent = 0.8f; ///< perspective: vertical field of view, radians; orthographic: height, metres

    bool operator==(Camera const&) const = default;

    Vec3 forward() const { return orientation * Vec3(0, 0, -1); }
    Vec3 up() const { return orientation * Vec3(0, 1, 0); }
    Vec3 right() const { return orientation * Vec3(1, 0, 0); }
};

/// Size of the picture in pixels; both sides at least 1.
struct Viewport {
    int width = 1280;
    int height = 720;

    bool operator==(Viewport const&) const = default;
};

/// Largest side of a viewport that either program accepts, pixels.
inline constexpr int max_viewport_side = 16384;

/// Rays of a view as affine functions of pixel coordinates: origin(x, y) = origin + x * origin_dx + y * origin_dy, and
/// the same for direction. Directions are not normalised: their component along the camera's forward axis is 1, so the
/// ray parameter t IS the view depth (metres along forward), and 1/t of a plane is affine in x and y.
struct ViewRays {
    Vec3 origin, origin_dx, origin_dy; ///< in the world, metres
    Vec3 direction, direction_dx, direction_dy; ///< in the world, metres for each metre of view depth
};

ViewRays make_view_rays(Camera const& camera, Viewport viewport);

/// A camera at `position` looking at `target`. `up` need not be orthogonal to the view; where it is parallel to it
/// another axis is taken.
Camera look_at(Vec3 position, Vec3 target, Vec3 up, float vertical_fov_radians);

/// True when every number is within the bounds above and the orientation is a rotation.
bool is_valid(Camera const& camera);

/// Moves position and extent to the nearest values within the bounds. For cameras of finite numbers that this program
/// has made itself: a scene's animation or a user's hand may lead them out.
Camera within_bounds(Camera camera);

} // namespace framelet
