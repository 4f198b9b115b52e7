// A scene made ready to be rendered: BVHs, mip chains, materials, lights, environment. A resource; its pose changes
// between cycles, and everything reads it during one.
#pragma once

#include <memory>

#include "server/render/environment.h"
#include "server/scene/animation.h"
#include "server/scene/scene.h"
#include "server/scene/scene_import.h"

namespace framelet {

class RenderScene {
public:
    /// Builds every BVH and mip chain. `scene` must outlive this. Scenes without lights get a sun; `environment` none
    /// means the default sky where the scene has no lights either, else a dim uniform one.
    RenderScene(Scene const& scene, std::optional<Environment> environment, Progress const& progress = {});
    ~RenderScene();
    RenderScene(RenderScene const&) = delete;
    RenderScene& operator=(RenderScene const&) = delete;

    /// Moves instances, refits what deforms. Costs nothing for what does not move. Not while anything renders.
    void set_pose(ScenePose const& pose);

    struct Impl;
    Impl const& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

} // namespace framelet
