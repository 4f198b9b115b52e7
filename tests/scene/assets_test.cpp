// Compares real models with the figures that their list gives. Skipped where they are not beside the checkout.
#include <gtest/gtest.h>

#include "common/error.h"
#include "server/scene/finish/tangents.h"
#include "server/scene/motion/animation.h"
#include "server/scene/scene_import.h"

namespace framelet {
namespace {

std::filesystem::path const assets = std::filesystem::path(FRAMELET_SOURCE_DIR) / ".." / "shared" / "assets";

struct Model {
    std::string file;
    std::size_t triangles, drawn, nodes, materials, images, cameras, lights;
    std::vector<std::pair<std::string, float>> clips;
    Vec3 lower, upper; ///< of the list: from the corners of the meshes' own boxes, before skinning; else rounded
    bool exact_box; ///< ours is exact: equal where nothing is rotated or skinned
    std::size_t playing = 0;
};

void PrintTo(Model const& model, std::ostream* out) {
    *out << model.file;
}

std::vector<Model> models() {
    return {
        {"CesiumMilkTruck/CesiumMilkTruck.glb",
         2856,
         3624,
         5,
         4,
         1,
         0,
         0,
         {{"", 1.25f}},
         {-2.431f, -0.069f, -1.396f},
         {2.438f, 2.584f, 1.396f},
         false,
         1},
        {"CesiumMan/CesiumMan.glb", 4672, 4672, 22, 1, 1, 0, 0, {{"", 2}}, {}, {}, false, 1},
        {"Fox/Fox.glb",
         576,
         576,
         26,
         1,
         1,
         0,
         0,
         {{"Survey", 3.417f}, {"Walk", 0.708f}, {"Run", 1.158f}},
         {},
         {},
         false,
         1},
        {"FlightHelmet/FlightHelmet.gltf",
         94722,
         94722,
         6,
         6,
         15,
         0,
         0,
         {},
         {-0.204f, 0, -0.172f},
         {0.163f, 0.716f, 0.2f},
         true},
        {"WaterBottle/WaterBottle.gltf",
         4510,
         4510,
         1,
         1,
         4,
         0,
         0,
         {},
         {-0.054f, -0.13f, -0.054f},
         {0.054f, 0.13f, 0.054f},
         true},
        {"DutchShip/dutch_ship_medium_1k.gltf",
         69162,
         69162,
         3,
         3,
         9,
         0,
         0,
         {},
         {-10.326f, -2, -3.488f},
         {13.745f, 22.657f, 3.321f},
         true},
        {"MorphStressTest/MorphStressTest.gltf",
         2412,
         2412,
         1,
         2,
         3,
         0,
         0,
         {{"Individuals", 9.333f}, {"Pulse", 6.333f}, {"TheWave", 1.958f}},
         {-2, -0.1f, -0.5f},
         {2, 0.5f, 0.5f},
         true,
         1},
        {"Campground/camp.gltf",
         6285,
         6285,
         4,
         12,
         0,
         1,
         0,
         {},
         {-10.072f, -3.378f, -9.072f},
         {11.545f, 7.715f, 13.54f},
         true},
        {"KayKitDungeon/KayKitDungeon.glb",
         38856,
         176749,
         821,
         1,
         1,
         5,
         18,
         {{"mechanisms", 12}, {"flythrough", 24}},
         {-0.9f, -1, -0.9f},
         {50.75f, 4, 42.96f},
         false,
         2},
        {"TorcsETrack6/TorcsETrack6.glb",
         35573,
         35573,
         2818,
         202,
         171,
         4,
         1,
         {{"drive", 30}},
         {-132.126f, -2.947f, -930.169f},
         {1630.81f, 86.352f, 114.284f},
         true,
         1},
        {"Apartment/Apartment.glb",
         925498,
         1031710,
         98,
         209,
         40,
         5,
         5,
         {{"fan", 10}, {"walk", 20}},
         {-0.15f, -0.1f, -0.15f},
         {9.15f, 2.8f, 7.15f},
         true,
         2},
        {"Peterbilt/peterbilt.obj", 116501, 116501, 1, 12, 0, 0, 0, {}, {}, {}, false},
        {"Spot/spot.obj", 5856, 5856, 1, 1, 1, 0, 0, {}, {}, {}, false},
    };
}

class Assets : public testing::TestWithParam<Model> {};

void expect_consistent(Scene const& scene) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        ASSERT_LT(scene.nodes[i].parent, static_cast<Index>(i));
    }
    for (Mesh const& mesh : scene.meshes) {
        for (Primitive const& p : mesh.primitives) {
            std::size_t const n = p.positions.size();
            ASSERT_EQ(p.normals.size(), n);
            Material const& material = scene.materials.at(static_cast<std::size_t>(p.material));
            ASSERT_EQ(p.tangents.size(), material.normal_texture.texture == none ? 0 : n);
            for (std::size_t i = 0; i < n; ++i) {
                ASSERT_NEAR(glm::length(p.normals[i]), 1, 1e-4f);
                if (!p.tangents.empty()) {
                    ASSERT_NEAR(glm::length(Vec3(p.tangents[i])), 1, 1e-4f);
                    ASSERT_EQ(std::abs(p.tangents[i].w), 1);
                }
            }
            for (JointInfluence const& influence : p.influences) {
                auto const& w = influence.weights;
                ASSERT_NEAR(w[0] + w[1] + w[2] + w[3], 1, 1e-5f);
                ASSERT_TRUE(w[0] >= w[1] && w[1] >= w[2] && w[2] >= w[3]);
            }
            for (auto const& t : p.triangles) {
                ASSERT_TRUE(t[0] < n && t[1] < n && t[2] < n);
            }
        }
    }
}

TEST_P(Assets, MatchTheirList) {
    Model const& model = GetParam();
    if (!std::filesystem::exists(assets / model.file)) {
        GTEST_SKIP() << "no " << model.file;
    }
    Scene const scene = import_scene(assets / model.file);
    std::size_t triangles = 0;
    std::size_t drawn = 0;
    for (Mesh const& mesh : scene.meshes) {
        for (Primitive const& primitive : mesh.primitives) {
            triangles += primitive.triangles.size();
        }
    }
    for (Node const& node : scene.nodes) {
        if (node.mesh != none) {
            for (Primitive const& primitive : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
                drawn += primitive.triangles.size();
            }
        }
    }
    EXPECT_EQ(triangles, model.triangles);
    EXPECT_EQ(drawn, model.drawn);
    EXPECT_EQ(scene.nodes.size(), model.nodes);
    EXPECT_EQ(scene.materials.size(), model.materials);
    EXPECT_EQ(scene.images.size(), model.images);
    EXPECT_EQ(scene.cameras.size(), model.cameras);
    EXPECT_EQ(scene.lights.size(), model.lights);
    ASSERT_EQ(scene.clips.size(), model.clips.size());
    for (std::size_t i = 0; i < scene.clips.size(); ++i) {
        EXPECT_NEAR(scene.clips[i].duration, model.clips[i].second, 1e-3f);
        EXPECT_TRUE(model.clips[i].first.empty() || scene.clips[i].name == model.clips[i].first) << scene.clips[i].name;
    }
    auto const clips = default_clips(scene);
    EXPECT_EQ(clips.size(), model.playing);
    ScenePose const pose = evaluate_pose(scene, clips, 0);
    Bounds const box = scene_bounds(scene, pose);
    ASSERT_FALSE(box.empty());
    if (model.lower != model.upper) {
        float const tolerance = 2e-3f + 1e-6f * glm::length(box.size());
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(box.lower[c], model.lower[c] - tolerance);
            EXPECT_LE(box.upper[c], model.upper[c] + tolerance);
            if (model.exact_box) {
                EXPECT_NEAR(box.lower[c], model.lower[c], tolerance);
                EXPECT_NEAR(box.upper[c], model.upper[c], tolerance);
            }
        }
    }
    EXPECT_TRUE(is_valid(default_camera(box)));
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        EXPECT_TRUE(is_valid(scene_camera(scene, pose, static_cast<Index>(i)))) << scene.cameras[i].name;
    }
    expect_consistent(scene);
}

INSTANTIATE_TEST_SUITE_P(All, Assets, testing::ValuesIn(models()),
                         [](auto const& test) { return test.param.file.substr(0, test.param.file.find('/')); });

Scene conformance(std::string const& name) {
    return import_scene(assets / "conformance" / name / (name + ".gltf"));
}

class Conformance : public testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(assets / "conformance")) {
            GTEST_SKIP() << "no conformance models";
        }
    }
};

Bounds box_at(Scene const& scene, double time) {
    return scene_bounds(scene, evaluate_pose(scene, default_clips(scene), time));
}

TEST_F(Conformance, Boxes) {
    for (std::string const name : {"BoxInterleaved", "BoxTexturedNonPowerOfTwo", "BoxVertexColors"}) {
        Scene const scene = conformance(name);
        EXPECT_EQ(scene.meshes.at(0).primitives.at(0).triangles.size(), 12u) << name;
        EXPECT_NEAR(glm::distance(box_at(scene, 0).size(), Vec3(1)), 0, 1e-5f) << name;
        EXPECT_TRUE(scene.warnings.empty()) << name << ": " << scene.warnings[0];
        expect_consistent(scene);
    }
    EXPECT_EQ(conformance("BoxTexturedNonPowerOfTwo").images.at(0)->width, 211);
    Scene const colored = conformance("BoxVertexColors");
    EXPECT_EQ(colored.meshes[0].primitives[0].colors.size(), 24u);
}

TEST_F(Conformance, BoxAnimatedOpensAndCloses) {
    Scene const scene = conformance("BoxAnimated");
    EXPECT_EQ(scene.clips.at(0).channels.size(), 2u);
    Bounds const closed = box_at(scene, 0);
    Bounds const open = box_at(scene, 2);
    EXPECT_GT(open.size().y, closed.size().y + 0.5f) << "the inner box comes out at the top";
}

TEST_F(Conformance, Cameras) {
    Scene const scene = conformance("Cameras");
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].projection, Projection::perspective);
    EXPECT_FLOAT_EQ(scene.cameras[0].vertical_extent, 0.7f);
    EXPECT_EQ(scene.cameras[1].projection, Projection::orthographic);
    EXPECT_FLOAT_EQ(scene.cameras[1].vertical_extent, 2);
    Camera const camera = scene_camera(scene, evaluate_pose(scene, {}, 0), 0);
    EXPECT_EQ(camera.position, Vec3(0.5f, 0.5f, 3));
    EXPECT_NEAR(glm::distance(camera.forward(), Vec3(0, 0, -1)), 0, 1e-6f);
}

TEST_F(Conformance, RiggedSimpleBends) {
    Scene const scene = conformance("RiggedSimple");
    EXPECT_EQ(scene.skins.at(0).joints.size(), 2u);
    EXPECT_EQ(scene.meshes.at(0).primitives.at(0).influences.size(), 96u);
    Bounds const straight = box_at(scene, 0);
    Bounds const bent = box_at(scene, 1);
    EXPECT_GT(glm::distance(straight.size(), bent.size()), 0.5f);
    EXPECT_GT(straight.size().y, 9) << "upright at first";
}

TEST_F(Conformance, SimpleMorphRisesTwice) {
    Scene const scene = conformance("SimpleMorph");
    // Keys at 0..4 s: (0,0), (0,1), (1,1), (1,0), (0,0).
    EXPECT_EQ(evaluate_pose(scene, default_clips(scene), 1).morph_weights[0], (std::vector<float>{0, 1}));
    EXPECT_EQ(evaluate_pose(scene, default_clips(scene), 2.5).morph_weights[0], (std::vector<float>{1, 0.5f}));
    EXPECT_NEAR(box_at(scene, 2).upper.y, 2.5f, 1e-5f) << "half and twice one";
}

TEST_F(Conformance, SimpleSparseAccessorMovesThreePoints) {
    Scene const scene = conformance("SimpleSparseAccessor");
    Bounds const box = box_at(scene, 0);
    EXPECT_EQ(box.upper, Vec3(6, 4, 0)) << "y would be 1 without the sparse values";
    EXPECT_EQ(scene.meshes[0].primitives[0].triangles.size(), 12u);
}

TEST_F(Conformance, TextureCoordinatesAndSettings) {
    Scene const coordinates = conformance("TextureCoordinateTest");
    EXPECT_EQ(coordinates.images.size(), 1u);
    EXPECT_EQ(coordinates.materials.size(), 5u);
    Scene const settings = conformance("TextureSettingsTest");
    EXPECT_EQ(settings.images.size(), 3u);
    bool clamp = false;
    bool mirror = false;
    bool nearest = false;
    for (Texture const& texture : settings.textures) {
        clamp = clamp || texture.wrap_u == Wrap::clamp || texture.wrap_v == Wrap::clamp;
        mirror = mirror || texture.wrap_u == Wrap::mirror || texture.wrap_v == Wrap::mirror;
        nearest = nearest || texture.nearest;
    }
    EXPECT_TRUE(clamp && mirror && !nearest);
}

TEST_F(Conformance, OneTriangleWithoutIndicesAndATwoSidedPlane) {
    Scene const triangle = conformance("TriangleWithoutIndices");
    EXPECT_EQ(triangle.meshes[0].primitives[0].triangles.size(), 1u);
    EXPECT_EQ(triangle.meshes[0].primitives[0].normals[0], Vec3(0, 0, 1));
    EXPECT_TRUE(conformance("TwoSidedPlane").materials.at(0).double_sided);
}

TEST_F(Conformance, NormalTangentTestGetsTangentsOnTheRightSide) {
    Scene const scene = conformance("NormalTangentTest");
    Primitive const& p = scene.meshes.at(0).primitives.at(0);
    ASSERT_EQ(p.tangents.size(), p.positions.size());
    for (std::size_t i = 0; i < p.tangents.size(); ++i) {
        ASSERT_NEAR(glm::dot(Vec3(p.tangents[i]), p.normals[i]), 0, 1e-4f);
    }
    expect_consistent(scene);
}

/// Compares our tangents with those that the authors' tools made and stored.
TEST(AssetTangents, AgreeWithStoredOnes) {
    for (std::string const name : {"FlightHelmet/FlightHelmet.gltf", "WaterBottle/WaterBottle.gltf"}) {
        if (!std::filesystem::exists(assets / name)) {
            GTEST_SKIP() << "no " << name;
        }
        std::size_t corners = 0;
        std::size_t same_side = 0;
        std::size_t close = 0;
        for (Mesh const& mesh : import_scene(assets / name).meshes) {
            for (Primitive const& stored : mesh.primitives) {
                Primitive made = stored;
                made.tangents.clear();
                make_tangents(made, stored.uv[0]);
                for (std::size_t t = 0; t < stored.triangles.size(); ++t) {
                    for (std::size_t k = 0; k < 3; ++k) {
                        Vec4 const theirs = stored.tangents[stored.triangles[t][k]];
                        Vec4 const ours = made.tangents[made.triangles[t][k]];
                        ++corners;
                        same_side += theirs.w == ours.w;
                        close += glm::dot(Vec3(theirs), Vec3(ours)) > 0.97f;
                    }
                }
            }
        }
        EXPECT_GE(same_side, corners * 99 / 100) << name << " of " << corners;
        EXPECT_GE(close, corners * 95 / 100) << name << " of " << corners;
    }
}

} // namespace
} // namespace framelet
