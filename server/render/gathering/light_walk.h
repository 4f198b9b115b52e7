// Looks about a scene before anybody does, so that its light is known where viewers come. In: cameras to set out from.
// Out: places that the scene's light cache was asked for. Deterministic.
#pragma once

#include <vector>

#include "common/camera.h"
#include "server/render/prepared/render_scene.h"

namespace framelet {

class LightWalk {
public:
    /// `cameras`: views that are looked at first, at least one.
    explicit LightWalk(std::vector<Camera> cameras);

    /// Renders the next view, in parallel on the calling TBB arena. The scene must have a light cache.
    void look(RenderScene const& scene);
    /// True once there are no more views.
    bool is_over() const;

private:
    Camera next_view() const;

    std::vector<Camera> cameras_;
    std::vector<Vec3> places_; ///< from which to look about, world
    std::uint32_t looks_ = 0;
};

} // namespace framelet
