#include "server/scene/summary/scene_identity.h"

#include <gtest/gtest.h>

#include "tests/session/triangle_scenes.h"

namespace framelet {
namespace {

TEST(SceneIdentity, IsTheSameForTheSameSceneOnly) {
    std::uint64_t const identity = scene_identity(moving_scene());
    EXPECT_EQ(scene_identity(moving_scene()), identity);
    EXPECT_NE(identity, 0u);
    EXPECT_NE(scene_identity(triangle_scene()), identity);
    Scene other = moving_scene();
    other.meshes[0].primitives[0].positions[1].x += 1;
    EXPECT_NE(scene_identity(other), identity);
    other = moving_scene();
    other.clips[0].channels[0].values[3] += 1;
    EXPECT_NE(scene_identity(other), identity);
    other = moving_scene();
    other.nodes[0].matrix = Mat4(2);
    EXPECT_NE(scene_identity(other), identity);
    other = moving_scene();
    other.materials[0].base_color.x = 0.5f;
    EXPECT_NE(scene_identity(other), identity);
}

} // namespace
} // namespace framelet
