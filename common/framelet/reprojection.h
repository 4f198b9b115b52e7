// Maps pixels of one view to pixels of another ([Nehab 2006], [Yang 2011]; layers: a homography each). A point of the
// source view is its pixel (x, y) and its inverse view depth w. Its homogeneous display pixel is affine in (x, y, w);
// on a plane w is affine in (x, y), so the whole plane moves by one 3x3 matrix, and its inverse depth is affine in the
// display too. In: cameras, motion of what is shown. Out: matrices. Perspective cameras only.
#pragma once

#include <optional>

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/vector_double2.hpp>
#include <glm/ext/vector_double3.hpp>

#include "common/camera.h"
#include "common/framelet/body_motion.h"
#include "common/framelet/framelet_shape.h"
#include "common/framelet/tile.h"

namespace framelet {

/// Maps a source pixel (x, y) of inverse depth w to the display: (x z, y z, z) = far * (x, y, 1) + parallax * w. The
/// display depth is z / w; z > 0 in front of the display camera.
struct ViewTransform {
    glm::dmat3 far{1};
    glm::dvec3 parallax{0};

    glm::dvec3 map(double x, double y, double w) const { return far * glm::dvec3(x, y, 1) + w * parallax; }
};

/// True for a camera to and from whose views the transform exists. Samples of or for an orthographic camera stay on
/// their pixels.
constexpr bool is_reprojectable(Camera const& camera) {
    return camera.projection == Projection::perspective;
}

/// The least display depth, as a share of the source depth, at which something is drawn: what is nearer would fill the
/// picture.
inline constexpr double nearest_share = 1e-3;

/// The transform of what has moved by `motion` and then by `drift` (metres in the world) between the two pictures.
ViewTransform make_view_transform(ViewRays const& source, ViewRays const& display, Motion const& motion = {},
                                  glm::dvec3 drift = glm::dvec3(0));

/// Maps a layer's plane from a source view to a display view and back. Source coordinates are pixels from the tile's
/// upper left corner (as in `Layer`), display coordinates are pixels of the display picture.
struct PlaneTransform {
    glm::dmat3 to_display; ///< source (x, y, 1) -> display (x z, y z, z)
    glm::dmat3 to_source; ///< display (x, y, 1) -> source (x / z, y / z, 1 / z)
    glm::dvec3 inverse_depth; ///< in the display, 1 / metres: its dot product with (x, y, 1), only where 1 / z > 0
};

/// What the drift of a layer changes from pixel to pixel, as a part of `PlaneTransform::to_display`: it is taken to be
/// as far away everywhere as in the layer's middle. `dx`, `dy`: metres a pixel, by the time that is shown; `middle`:
/// pixels from the tile's corner.
glm::dmat3 make_stretch(Layer const& layer, ViewRays const& display, glm::dvec2 middle, glm::dvec3 dx, glm::dvec3 dy);

/// The maps of a layer's plane; none where the display camera sees the plane edge-on or from behind. `stretch`: as
/// `make_stretch` has it.
std::optional<PlaneTransform> make_plane_transform(ViewTransform const& view, Layer const& layer,
                                                   glm::dvec2 tile_corner, glm::dmat3 const& stretch = glm::dmat3(0));

/// The pixel box of the display picture that holds every pixel at whose centre a source rectangle [low, high] shows in
/// front of the display camera, clipped to the viewport; empty where there is none.
PixelRect display_box(glm::dmat3 const& to_display, glm::dvec2 low, glm::dvec2 high, Viewport viewport);

} // namespace framelet
