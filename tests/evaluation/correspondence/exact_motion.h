// Where what is seen from one camera at one time is seen from another camera at another time: straight from the scene's
// animation, without layers, keys or wire. In: bodies, two poses of the scene, two cameras. Out: places in the picture.
#pragma once

#include <utility>
#include <vector>

#include "common/camera.h"
#include "server/scene/motion/bodies.h"

namespace framelet::bench {

/// A scene at one time and a camera that looks at it.
struct SceneView {
    ScenePose const& pose;
    Camera camera;
};

class ExactMotion {
public:
    ExactMotion(SceneBodies const& bodies, SceneView const& from, SceneView const& to, Viewport viewport);

    struct Place {
        Vec2 pixel{NAN}; ///< not a number: behind the eye, or nearly
        float inverse_depth = 0; ///< 1 / metres
    };

    /// Of what is seen at the pixel `place` at that inverse depth (0: the sky). What no body carries moves on by
    /// `velocity`, metres a second.
    Place shown(Vec2 place, float inverse_depth, BodyNumber body, Vec3 const& velocity) const;

private:
    float seconds_; ///< from the first to the second
    ViewRays rays_;
    Vec3 eye_;
    Mat3 to_pixels_; ///< world to homogeneous pixel; the third is the view depth
    std::vector<std::pair<BodyPose, BodyPose>> poses_;
};

} // namespace framelet::bench
