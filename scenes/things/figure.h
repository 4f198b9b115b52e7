// A person as one skin over sixteen joints. It faces +Z, its left is +X, it stands on y = 0 and is 1.78 m tall.
#pragma once

#include <array>
#include <cstdint>

#include "scenes/gltf/gltf_document.h"

namespace framelet {

/// Joints of a figure; those of the right side come after the left ones, in the same order.
enum class FigureJoint : std::uint8_t { pelvis, spine, chest, head, upper_arm, forearm, hand, thigh, shin, foot };
inline constexpr int joints_of_a_side = 6;
inline constexpr int figure_joints = 10 + joints_of_a_side;

/// The number of a joint; `side` is 0 for those of the middle and the left, 1 for the right.
constexpr int joint_number(FigureJoint joint, int side = 0) {
    return static_cast<int>(joint) + side * joints_of_a_side;
}
/// The joint that carries this one; no_index for the pelvis.
int parent_joint(int joint);
/// Where a joint of the standing figure is, in the figure's space, metres.
D3 joint_place(int joint);

/// Colours of a figure, linear; `shirt` is printed with stripes.
struct FigureLook {
    D3 shirt, trousers, shoes, skin, hair;
};
/// Adds the mesh of such a figure; several figures may share it.
int add_figure_mesh(GltfDocument& document, FigureLook const& look);

/// One figure's nodes. Its joints stand without any rotation where `joint_place` says.
struct Figure {
    int root = 0;
    std::array<int, figure_joints> joints{};
};
Figure add_figure(GltfDocument& document, int mesh, Placement const& place, int parent = no_index);

} // namespace framelet
