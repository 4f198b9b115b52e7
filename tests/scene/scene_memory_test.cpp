#include "server/scene/finish/scene_memory.h"

#include <gtest/gtest.h>

#include "common/error.h"

namespace framelet {
namespace {

constexpr std::uint64_t triangles = 1000;

/// A mesh of 1,000 triangles of 3,000 vertices of 24 bytes each, shown by so many nodes.
Scene scene_of(std::size_t nodes) {
    Scene scene;
    scene.name = "rocks";
    Primitive primitive;
    primitive.positions.resize(3 * triangles);
    primitive.normals.resize(3 * triangles);
    primitive.triangles.resize(triangles);
    scene.meshes.push_back({"rock", {primitive}, {}});
    scene.nodes.resize(nodes);
    for (Node& node : scene.nodes) {
        node.mesh = 0;
    }
    return scene;
}

constexpr std::uint64_t geometry_bytes = triangles * (3 * 24 + 12);

TEST(SceneMemory, CountsGeometryAndPictures) {
    Scene scene = scene_of(1);
    EXPECT_EQ(scene_bytes(scene), geometry_bytes);
    scene.images = {std::make_shared<Picture const>(Picture(10, 20)), nullptr};
    EXPECT_EQ(scene_bytes(scene), geometry_bytes + 800);
}

TEST(SceneMemory, AMeshCountsOnceAndOnceMoreForEachNodeThatDeformsIt) {
    Scene scene = scene_of(5);
    EXPECT_EQ(triangles_to_build(scene), triangles);
    scene.nodes[3].skin = 0;
    scene.nodes[4].skin = 0;
    EXPECT_EQ(triangles_to_build(scene), 3 * triangles);
    scene.meshes[0].primitives[0].morph_targets.resize(1);
    EXPECT_EQ(triangles_to_build(scene), 5 * triangles);
}

TEST(SceneMemory, TheBvhIsFastWhereThereIsMuchRoomAndCompactWhereThereIsLittle) {
    Scene scene = scene_of(100);
    EXPECT_EQ(bvh_within(scene, 400 * triangles), BvhKind::fast);
    EXPECT_EQ(bvh_within(scene, 399 * triangles), BvhKind::compact) << "more than a quarter";
    EXPECT_EQ(bvh_within(scene, geometry_bytes + 42 * triangles), BvhKind::compact);
    EXPECT_THROW(bvh_within(scene, geometry_bytes + 42 * triangles - 1), InputError);
    EXPECT_THROW(bvh_within(scene, 0), InputError);
    scene.bvh = BvhKind::compact;
    std::uint64_t const compact = bvh_bytes(scene);
    scene.bvh = BvhKind::fast;
    EXPECT_LT(compact, bvh_bytes(scene));
    EXPECT_EQ(bvh_within(Scene{}, 0), BvhKind::fast) << "what is empty has room anywhere";
}

} // namespace
} // namespace framelet
