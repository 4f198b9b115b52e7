// What the scenes of the characters, the flag and the fan are for has to happen in them.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "scenes/failure_scenes.h"
#include "server/scene/motion/animation.h"
#include "server/scene/motion/switches.h"
#include "server/scene/scene_import.h"

namespace framelet {
namespace {

GltfNode const& node_named(GltfDocument const& document, std::string const& name) {
    auto const found = std::ranges::find(document.nodes, name, &GltfNode::name);
    EXPECT_NE(found, document.nodes.end());
    return *found;
}

class LoopingScene : public testing::TestWithParam<std::string> {};

TEST_P(LoopingScene, EndsAsItBegins) {
    Scene const scene = import_scene(std::string(FRAMELET_SOURCE_DIR "/scenes/") + GetParam() + ".glb");
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    EXPECT_TRUE(find_switches(scene, default_clips(scene)).empty());
    EXPECT_GT(animation_duration(scene, default_clips(scene)), 0);
}

INSTANTIATE_TEST_SUITE_P(Names, LoopingScene,
                         testing::Values("walker", "flag", "fan", "windmill", "globe", "foliage", "dim", "stop"),
                         [](auto const& instance) { return instance.param; });

/// How far the cloth swings at one vertex, at one key of its clip, metres.
double swing_at(GltfPrimitive const& cloth, GltfTrack const& track, std::size_t vertex, std::size_t key) {
    double sum = 0;
    for (std::size_t t = 0; t < cloth.targets.size(); ++t) {
        sum += track.values[key][static_cast<int>(t)] * cloth.targets[t].positions[vertex].z;
    }
    return sum;
}

TEST(FlagScene, WavesTravelFromTheMastWhichHoldsTheCloth) {
    GltfDocument const document = make_flag_scene({});
    for (std::string const name : {"flag", "pennant"}) {
        GltfNode const& node = node_named(document, name);
        GltfPrimitive const& cloth = document.meshes[static_cast<std::size_t>(node.mesh)].primitives.at(0);
        ASSERT_GE(cloth.targets.size(), 4u);
        auto const track = std::ranges::find_if(document.tracks, [&](GltfTrack const& t) {
            return &document.nodes[static_cast<std::size_t>(t.nodes[0])] == &node;
        });
        ASSERT_NE(track, document.tracks.end());
        double length = 0;
        for (std::size_t i = 0; i < cloth.data.positions.size(); ++i) {
            length = std::max(length, cloth.data.positions[i].x);
            for (GltfMorphTarget const& target : cloth.targets) {
                EXPECT_TRUE(cloth.data.positions[i].x > 0 || target.positions[i] == D3(0)) << "the mast holds it";
            }
        }
        // What the free half does is done a little nearer to the mast some keys before: more like it than some after.
        double before = 0;
        double after = 0;
        for (std::size_t i = 0; i + 1 < cloth.data.positions.size(); ++i) {
            D3 const& at = cloth.data.positions[i];
            if (at.x < 0.5 * length || !(cloth.data.positions[i + 1].x > at.x)) {
                continue;
            }
            for (std::size_t key = 1; key + 1 < track->values.size(); ++key) {
                double const farther = swing_at(cloth, *track, i + 1, key);
                before += std::pow(farther - swing_at(cloth, *track, i, key - 1), 2);
                after += std::pow(farther - swing_at(cloth, *track, i, key + 1), 2);
            }
        }
        EXPECT_LT(before, 0.5 * after) << name;
    }
}

TEST(FlagScene, NormalsAreThoseOfTheShape) {
    GltfDocument const document = make_flag_scene({});
    GltfNode const& node = node_named(document, "flag");
    GltfPrimitive const& cloth = document.meshes[static_cast<std::size_t>(node.mesh)].primitives.at(0);
    D4 const weights(0.6, -0.8, 0.28, 0.96);
    auto const moved = [&](std::vector<D3> const& values, std::vector<D3> GltfMorphTarget::*offsets, std::size_t i) {
        D3 sum = values[i];
        for (std::size_t t = 0; t < cloth.targets.size(); ++t) {
            sum += weights[static_cast<int>(t)] * (cloth.targets[t].*offsets)[i];
        }
        return sum;
    };
    MeshData const& data = cloth.data;
    for (std::size_t i = 0; i < data.indices.size(); i += 3) {
        D3 corners[3], normal(0);
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = moved(data.positions, &GltfMorphTarget::positions, data.indices[i + k]);
            normal += glm::normalize(moved(data.normals, &GltfMorphTarget::normals, data.indices[i + k]));
        }
        D3 const face = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        EXPECT_GT(glm::dot(glm::normalize(face), glm::normalize(normal)), std::cos(radians(4)));
    }
}

TEST(FanScene, BladesPassBetweenTheLampAndTableFloorAndWall) {
    GltfDocument const document = make_fan_scene({});
    GltfNode const& rotor = node_named(document, "rotor");
    D3 const lamp = node_named(document, "light").place.translation;
    double reach = 0;
    for (GltfPrimitive const& part : document.meshes[static_cast<std::size_t>(rotor.mesh)].primitives) {
        for (D3 const& position : part.data.positions) {
            reach = std::max(reach, std::hypot(position.x, position.z));
        }
    }
    D3 const hub = rotor.place.translation;
    ASSERT_GT(lamp.y, hub.y + 0.3) << "the lamp is above the blades";
    D3 const table = node_named(document, "table").place.translation + D3(0, 0.76, 0);
    for (D3 const place : {table, D3(0.5, 0, -0.5), D3(-3.2, 1.2, 0), D3(-0.8, 1.5, -2.8)}) {
        double const share = (lamp.y - hub.y) / (lamp.y - place.y); // of the ray from the lamp, at the blades' height
        D3 const at = glm::mix(lamp, place, share) - hub;
        EXPECT_GT(std::hypot(at.x, at.z), 0.2);
        EXPECT_LT(std::hypot(at.x, at.z), reach);
    }
}

} // namespace
} // namespace framelet
