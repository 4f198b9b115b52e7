// Tests what --info says of a scene, as text and as JSON, with names that a terminal would obey.
#include "server/scene/summary/scene_summary.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/scene/motion/animation.h"

namespace framelet {
namespace {

bool has(std::string const& text, std::string const& part) {
    return text.find(part) != std::string::npos;
}

Scene two_that_share_a_mesh() {
    Scene scene;
    scene.name = "yard";
    scene.materials.emplace_back();
    Primitive triangle;
    triangle.positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
    triangle.normals.assign(3, {0, 0, 1});
    triangle.triangles = {{0, 1, 2}};
    scene.meshes.push_back({"flag", {triangle}, {}});
    scene.nodes.resize(3);
    scene.nodes[0].name = "still";
    scene.nodes[0].mesh = 0;
    scene.nodes[1].name = "gate\033[31m";
    scene.nodes[1].mesh = 0;
    scene.lights.push_back({.name = "lamp", .type = LightType::spot, .node = 0});
    scene.cameras.push_back({.name = "rider", .node = 1});
    AnimationChannel const turn{.node = 1, .times = {0, 2.5f}, .values = {0, 0, 0, 1, 0, 0}};
    scene.clips = {{"swing", 2.5f, {turn}}, {"swing more", 4, {turn}}};
    scene.warnings = {"extension ACME_fog is not supported and passed over"};
    return scene;
}

TEST(SceneSummary, TextNamesWhatThereIsAndWhatIsNot) {
    Scene const scene = two_that_share_a_mesh();
    std::string const text = scene_summary_text(scene, default_clips(scene));
    for (char const* const part : {"yard\n", "2 triangles, 1 mesh, 3 nodes", "2.00 x 3.00 x 0.00 m", "lamp, spot",
                                   "rider, moves", "of it the fast BVH 0.0 MB", "swing, 2.50 s\n",
                                   "swing more, 4.00 s, does not play", "1 body\n", "ACME_fog"}) {
        EXPECT_TRUE(has(text, part)) << part << " in\n" << text;
    }
    EXPECT_FALSE(has(text, "\033")) << text;
    std::string const nothing = scene_summary_text(Scene{}, {});
    for (char const* const part : {"(no name)\n", "nothing to see", "a sun and a sky", "one that frames the scene"}) {
        EXPECT_TRUE(has(nothing, part)) << part << " in\n" << nothing;
    }
}

TEST(SceneSummary, TellsTheSizeWithAndWithoutABackdrop) {
    Scene scene = two_that_share_a_mesh();
    EXPECT_FALSE(has(scene_summary_text(scene, {}), "backdrop"));
    Primitive sky = scene.meshes[0].primitives[0];
    sky.positions = {{-100, -10, -100}, {100, -10, 100}, {0, 90, 0}};
    sky.material = 1;
    scene.materials.emplace_back().unlit = true;
    scene.meshes.push_back({"sky", {sky}, {}});
    scene.nodes[2].mesh = 1;
    std::string const text = scene_summary_text(scene, {});
    EXPECT_TRUE(has(text, "200.00 x 100.00 x 200.00 m, without its backdrop 2.00 x 3.00 x 0.00 m")) << text;
    auto const json = nlohmann::json::parse(scene_summary_json(scene, {}));
    EXPECT_EQ(json["bounds"]["high"][1], 90);
    EXPECT_EQ(json["bounds_without_backdrop"]["high"][1], 3);
}

TEST(SceneSummary, JsonSaysTheSame) {
    Scene scene = two_that_share_a_mesh();
    scene.nodes[1].name = "gate\xff";
    auto const json = nlohmann::json::parse(scene_summary_json(scene, default_clips(scene)));
    EXPECT_EQ(json["triangles"], 2);
    EXPECT_EQ(json["meshes"], 1);
    EXPECT_EQ(json["duration_seconds"], 2.5);
    EXPECT_EQ(json["moving_bodies"].size(), 1u);
    EXPECT_EQ(json["clips"][1]["plays"], false);
    EXPECT_EQ(json["passed_over"].size(), 1u);
    EXPECT_EQ(json["anything_to_see"], true);
}

} // namespace
} // namespace framelet
