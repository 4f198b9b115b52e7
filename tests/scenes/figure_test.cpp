#include "scenes/things/figure.h"

#include <algorithm>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

namespace framelet {
namespace {

struct AFigure : testing::Test {
    GltfDocument document;
    int const mesh = add_figure_mesh(document, {D3(1), D3(0.5), D3(0.1), D3(0.6), D3(0.05)});

    std::vector<GltfPrimitive> const& parts() const {
        return document.meshes.at(static_cast<std::size_t>(mesh)).primitives;
    }
};

double weight_of(JointWeights const& moved_by, int joint) {
    double weight = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        weight += moved_by.joints[k] == joint ? moved_by.weights[k] : 0;
    }
    return weight;
}

TEST_F(AFigure, IsMovedByEachOfItsJointsAndFollowsThemWhole) {
    std::set<int> used;
    for (GltfPrimitive const& part : parts()) {
        ASSERT_EQ(part.data.joint_weights.size(), part.data.positions.size());
        for (JointWeights const& moved_by : part.data.joint_weights) {
            EXPECT_NEAR(std::accumulate(moved_by.weights.begin(), moved_by.weights.end(), 0.0), 1, 1e-12);
            for (std::size_t k = 0; k < 4; ++k) {
                EXPECT_GE(moved_by.weights[k], 0);
                if (moved_by.weights[k] > 0.99) {
                    used.insert(moved_by.joints[k]);
                }
            }
        }
    }
    EXPECT_EQ(used.size(), std::size_t(figure_joints));
}

TEST_F(AFigure, BendsSmoothly) {
    constexpr std::size_t two_rings = 28; // vertices; of a hand's skin, the thinnest
    for (int joint = 1; joint < figure_joints; ++joint) {
        std::size_t shared = 0;
        for (GltfPrimitive const& part : parts()) {
            shared +=
                static_cast<std::size_t>(std::ranges::count_if(part.data.joint_weights, [&](auto const& moved_by) {
                    return std::min(weight_of(moved_by, joint), weight_of(moved_by, parent_joint(joint))) > 0.02;
                }));
        }
        EXPECT_GE(shared, two_rings) << "joint " << joint;
    }
}

TEST_F(AFigure, StandsOnTheGroundAsTallAsAPerson) {
    double low = 1;
    double high = 0;
    for (GltfPrimitive const& part : parts()) {
        for (D3 const& position : part.data.positions) {
            low = std::min(low, position.y);
            high = std::max(high, position.y);
        }
    }
    EXPECT_NEAR(low, 0, 1e-9);
    EXPECT_NEAR(high, 1.78, 0.01);
}

TEST_F(AFigure, HasItsJointsWhereItsSkinSaysThatTheyAre) {
    Figure const figure = add_figure(document, mesh, {{3, 0, 0}});
    GltfSkin const& skin = document.skins.at(0);
    ASSERT_EQ(skin.joints.size(), std::size_t(figure_joints));
    for (std::size_t joint = 0; joint < skin.joints.size(); ++joint) {
        EXPECT_EQ(skin.joints[joint], figure.joints[joint]);
        D3 place(0);
        for (int node = skin.joints[joint]; node != figure.root;) {
            place += document.nodes[static_cast<std::size_t>(node)].place.translation;
            auto const carrier = std::ranges::find_if(
                document.nodes, [node](GltfNode const& n) { return std::ranges::count(n.children, node) > 0; });
            ASSERT_NE(carrier, document.nodes.end());
            node = static_cast<int>(carrier - document.nodes.begin());
        }
        EXPECT_LT(glm::distance(place, skin.places[joint]), 1e-12);
    }
}

} // namespace
} // namespace framelet
