// Finds where pieces lie in the picture of another moment. A viewer moves what it holds there; or it leaves all where
// it was rendered, which then is as worn as it is out of place. In: pieces of one moment, the cameras and times of
// both, how bodies move. Out: for each piece the box that it covers, how near and how worn it is.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/camera.h"
#include "common/framelet/body_motion.h"
#include "server/sampling/mirror/piece.h"

namespace framelet {

/// A camera and a scene time.
struct MirrorView {
    ViewRays rays{};
    SceneTime scene_time = 0;
};

/// True where cameras see the same.
bool same_camera(ViewRays const& a, ViewRays const& b);

/// A piece in the picture of another moment.
struct ReprojectedPiece {
    Vec2 at{0}; ///< its middle, pixels
    Vec2 half_side{0}; ///< of the box that it covers, pixels
    float inverse_depth = -1; ///< at its middle, 1 / metres; < 0: it is not in the picture, and the rest says nothing
    Vec2 depth_slope{0}; ///< slope of the inverse depth, 1 / metres a pixel
    float tolerance = 0; ///< by which its inverse depths may differ, 1 / metres
    float scale = 1; ///< how much larger it is than it was rendered
    float worn = 0; ///< worn spacing, pixels
    Vec2 way{0}; ///< of a viewer that moves nothing: how far what it shows has gone from there, pixels
    bool leads = false; ///< a shadow that shows before what it comes over
    bool is_still = false; ///< its pixels are where they were rendered
    bool is_outdated = false; ///< the scene has jumped since it was rendered
    bool is_lost = false; ///< it has drifted for longer than is known where to

    bool is_in_picture() const { return inverse_depth >= 0; }
};

/// Takes pixels of one body to the other picture, as `ViewTransform` does.
struct BodyTransform {
    std::uint64_t stamp = 0; ///< of the call and the scene time for which it holds
    Mat3 far{1};
    Vec3 parallax{0};
    std::array<Vec3, 3> carried{}; ///< parallax of a metre along each axis of the world
    float lens = 1; ///< how much larger the other camera's lens shows things
    bool is_still = false; ///< pixels stay where they are
};

/// Scratch: transforms that are found once for all pieces of a body and a scene time, and kept so that nothing is
/// allocated again.
struct BodyTransforms {
    std::vector<BodyTransform> of_body;
    std::uint64_t stamp = 0;
};

/// Mapping of pieces from the picture of one moment to that of another.
struct PieceReprojection {
    ViewRays source{}; ///< the moment's camera
    MirrorView display{};
    Vec2 display_size{0}; ///< pixels
    BodyMotions const* motions = nullptr; ///< not null
    bool moves_samples = true; ///< the viewer does, from and to perspective cameras
};

/// Sets `reprojected`, one for each piece. Not in the picture are outliers unless `with_outliers`, what lies
/// outside, and what is too coarse or too uncertain to hide anything.
void reproject(PieceReprojection const& reprojection, std::span<Piece const> pieces, bool with_outliers,
               BodyTransforms& transforms, std::span<ReprojectedPiece> reprojected);

} // namespace framelet
