// Computes where a point seen from one camera at one time is seen from another camera at another time: straight from
// the scene's animation, without layers, keys or wire. In: bodies, two poses of the scene, two cameras. Out: positions
// in the picture.
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

    struct Projected {
        Vec2 pixel{NAN}; ///< pixels; not a number: behind the eye, or nearly
        float inverse_depth = 0; ///< 1 / metres
    };

    /// The projection to the second view of the point seen in the first at `position` (pixels) with that inverse depth
    /// (1/m; 0: the sky), carried by `body`, with that drift besides.
    Projected shown(Vec2 position, float inverse_depth, BodyNumber body, Drift const& drift) const;

private:
    float seconds_; ///< time from the first view to the second, seconds
    ViewRays rays_;
    Vec3 eye_;
    Mat3 to_pixels_; ///< world offset from the second eye to homogeneous pixel; third component: view depth
    std::vector<std::pair<BodyPose, BodyPose>> poses_;
};

} // namespace framelet::bench
