#include "server/session/welcome.h"

#include "framelet_version.h"
#include "server/scene/backdrop.h"
#include "server/scene/motion/animation.h"
#include "server/scene/summary/scene_identity.h"

namespace framelet {

Welcome make_welcome(Scene const& scene, std::span<Index const> clips) {
    ScenePose const pose = evaluate_pose(scene, clips, 0);
    Welcome welcome;
    welcome.server = "framelet-server " FRAMELET_VERSION;
    welcome.scene_name = scene.name;
    welcome.scene_bounds = without_backdrop(scene_parts(scene, pose));
    for (Index i = 0; i < static_cast<Index>(scene.cameras.size()); ++i) {
        welcome.cameras.push_back({scene.cameras[static_cast<std::size_t>(i)].name, scene_camera(scene, pose, i)});
    }
    welcome.start_camera =
        welcome.cameras.empty() ? default_camera(welcome.scene_bounds) : welcome.cameras.front().camera;
    welcome.animation_duration = animation_duration(scene, clips);
    welcome.scene_identity = scene_identity(scene);
    welcome.scene_source = scene_source(scene);
    welcome.scene_origin = scene.origin;
    return welcome;
}

} // namespace framelet
