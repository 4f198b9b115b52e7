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

TEST(SceneIdentity, APlaceIsTheSameForTheSameFileOnly) {
    Scene scene = moving_scene();
    EXPECT_EQ(scene_source(scene), 0u);
    scene.files = {"/somewhere/model.glb"};
    std::uint64_t const place = scene_source(scene);
    EXPECT_NE(place, 0u);
    Scene changed = triangle_scene();
    changed.files = {"/somewhere/else/../model.glb", "/somewhere/texture.png"};
    EXPECT_EQ(scene_source(changed), place);
    changed.scene_files = 2;
    EXPECT_NE(scene_source(changed), place) << "of two files";
    scene.files = {"/elsewhere/model.glb"};
    EXPECT_NE(scene_source(scene), place);
}

} // namespace
} // namespace framelet
