#include "scenes/things/figure.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"

namespace framelet {
namespace {

using enum FigureJoint;

struct JointForm {
    char const* name;
    int parent;
    D3 place; ///< metres; on the left
};
constexpr std::array<JointForm, 10> forms{{{"pelvis", no_index, {0, 0.96, 0}},
                                           {"spine", joint_number(pelvis), {0, 1.08, 0}},
                                           {"chest", joint_number(spine), {0, 1.26, 0}},
                                           {"head", joint_number(chest), {0, 1.51, 0}},
                                           {"upper arm", joint_number(chest), {0.185, 1.42, 0}},
                                           {"forearm", joint_number(upper_arm), {0.245, 1.136, 0}},
                                           {"hand", joint_number(forearm), {0.299, 0.882, 0}},
                                           {"thigh", joint_number(pelvis), {0.095, 0.92, 0}},
                                           {"shin", joint_number(thigh), {0.095, 0.50, 0}},
                                           {"foot", joint_number(shin), {0.095, 0.08, 0}}}};

bool is_right(int joint) {
    return joint >= int(forms.size());
}

JointForm const& form_of(int joint) {
    return forms.at(static_cast<std::size_t>(is_right(joint) ? joint - joints_of_a_side : joint));
}

/// A ring of a tube: an ellipse at `along` the tube's axis, `shift` towards +Z.
struct Ring {
    double along; ///< metres
    double width, depth; ///< half axes, metres
    double shift = 0;
};

/// From which place along a tube on a joint moves it, and within which distance of that it takes over from the joint
/// before.
struct Link {
    int joint;
    double from = -1, blend = 1; ///< metres
};

/// Every joint's weight at a place along the tube. The places at which two of them take over are apart, so that no
/// more than two joints move it.
JointWeights weights_at(std::span<Link const> links, double along) {
    JointWeights moved_by;
    std::size_t used = 0;
    for (std::size_t i = 0; i < links.size(); ++i) {
        auto const reached = [&](Link const& link) {
            return smooth_step(0.5 + 0.5 * (along - link.from) / link.blend);
        };
        double const weight = (i == 0 ? 1 : reached(links[i])) - (i + 1 < links.size() ? reached(links[i + 1]) : 0);
        if (weight > 0) {
            moved_by.joints.at(used) = links[i].joint;
            moved_by.weights.at(used++) = weight;
        }
    }
    return moved_by;
}

/// A smooth curve through the rings that goes no farther than they do; `t` in [0, 1] from the first to the last.
Ring ring_at(std::span<Ring const> rings, double t) {
    double const at = t * static_cast<double>(rings.size() - 1);
    auto const i = std::min(static_cast<std::size_t>(at), rings.size() - 2);
    double const x = at - static_cast<double>(i);
    auto const through = [&](double Ring::*value) {
        auto const step = [&](std::size_t from) { return rings[from + 1].*value - rings[from].*value; };
        // The harmonic mean of the steps to both sides; level where they go up and down, and at both ends.
        auto const slope = [&](std::size_t ring) {
            bool const inside = ring > 0 && ring + 1 < rings.size();
            double const product = inside ? step(ring - 1) * step(ring) : 0;
            return product > 0 ? 2 * product / (step(ring - 1) + step(ring)) : 0;
        };
        double const rest = slope(i) * (1 - x) - slope(i + 1) * x;
        return rings[i].*value + smooth_step(x) * step(i) + x * (1 - x) * rest;
    };
    return {through(&Ring::along), through(&Ring::width), through(&Ring::depth), through(&Ring::shift)};
}

/// Adds a tube about the Y axis of `place`. The texture goes `repeats` times round and along it.
void add_tube(MeshData& mesh, std::span<Ring const> rings, int columns, int rows, D2 repeats,
              std::span<Link const> links, Placement const& place = {}) {
    MeshData tube = make_surface(
        columns, rows,
        [&](double u, double v) {
            Ring const ring = ring_at(rings, v);
            double const angle = 2 * pi * (u >= 1 ? 0 : u);
            return D3(ring.width * std::sin(angle), ring.along, ring.depth * std::cos(angle) + ring.shift);
        },
        repeats);
    for (D3 const& position : tube.positions) {
        tube.joint_weights.push_back(weights_at(links, position.y));
    }
    append(mesh, tube, place);
}

/// Adds a part that one joint alone moves.
void add_stiff(MeshData& mesh, MeshData part, int joint, Placement const& place) {
    part.joint_weights.assign(part.positions.size(), {{joint}, {1}});
    append(mesh, part, place);
}

struct FigureParts {
    MeshData shirt, trousers, shoes, skin, hair, eyes;
};

void add_trunk(FigureParts& parts) {
    constexpr std::array<Link, 4> links{Link{joint_number(pelvis)}, Link{joint_number(spine), 1.08, 0.06},
                                        Link{joint_number(chest), 1.26, 0.08}, Link{joint_number(head), 1.51, 0.03}};
    constexpr std::array<Ring, 8> seat{Ring{0.85, 0, 0, -0.01},          Ring{0.85, 0.08, 0.06, -0.01},
                                       Ring{0.88, 0.14, 0.10, -0.012},   Ring{0.93, 0.166, 0.118, -0.014},
                                       Ring{0.98, 0.163, 0.116, -0.012}, Ring{1.03, 0.15, 0.103, -0.006},
                                       Ring{1.07, 0.142, 0.095},         Ring{1.07, 0, 0}};
    constexpr std::array<Ring, 10> shirt{Ring{1.01, 0, 0},         Ring{1.01, 0.158, 0.110, -0.005},
                                         Ring{1.09, 0.15, 0.104},  Ring{1.17, 0.153, 0.106},
                                         Ring{1.25, 0.166, 0.112}, Ring{1.33, 0.178, 0.114},
                                         Ring{1.40, 0.18, 0.104},  Ring{1.45, 0.15, 0.084, -0.006},
                                         Ring{1.49, 0.075, 0.066}, Ring{1.50, 0.058, 0.056}};
    constexpr std::array<Ring, 10> face{Ring{1.45, 0.05, 0.05, -0.01},   Ring{1.49, 0.054, 0.055, -0.008},
                                        Ring{1.53, 0.05, 0.054},         Ring{1.55, 0.054, 0.07, 0.016},
                                        Ring{1.58, 0.067, 0.086, 0.018}, Ring{1.63, 0.075, 0.095, 0.012},
                                        Ring{1.68, 0.074, 0.095, 0.004}, Ring{1.72, 0.062, 0.08},
                                        Ring{1.75, 0.034, 0.044},        Ring{1.757, 0, 0}};
    constexpr std::array<Ring, 7> hair{Ring{1.57, 0.066, 0.05, -0.05},   Ring{1.60, 0.079, 0.078, -0.026},
                                       Ring{1.65, 0.083, 0.098, -0.01},  Ring{1.70, 0.081, 0.099, -0.004},
                                       Ring{1.74, 0.066, 0.082, -0.004}, Ring{1.773, 0.034, 0.044, -0.004},
                                       Ring{1.78, 0, 0, -0.004}};
    add_tube(parts.trousers, seat, 24, 14, {6, 2}, links);
    add_tube(parts.shirt, shirt, 28, 27, {4, 5}, links);
    add_tube(parts.skin, face, 20, 27, {1, 1}, links);
    add_tube(parts.hair, hair, 20, 18, {1, 1}, links);
    add_stiff(parts.skin, make_cone(0.016, 0.034, 8), joint_number(head),
              {{0, 1.615, 0.098}, rotation_about({1, 0, 0}, radians(60)), {1, 1, 1}});
    for (double const x : {-0.03, 0.03}) {
        add_stiff(parts.eyes, make_sphere(0.011, 8), joint_number(head), {{x, 1.65, 0.094}});
    }
}

void add_arm(FigureParts& parts, int side) {
    D3 const shoulder = joint_place(joint_number(upper_arm, side));
    D3 const arm = joint_place(joint_number(hand, side)) - shoulder;
    double const elbow = glm::distance(shoulder, joint_place(joint_number(forearm, side)));
    std::array<Link, 4> const links{Link{joint_number(chest)}, Link{joint_number(upper_arm, side), 0.0, 0.05},
                                    Link{joint_number(forearm, side), elbow, 0.05},
                                    Link{joint_number(hand, side), glm::length(arm), 0.03}};
    constexpr std::array<Ring, 7> sleeve{Ring{-0.065, 0, 0},      Ring{-0.045, 0.04, 0.045}, Ring{0, 0.06, 0.064},
                                         Ring{0.07, 0.058, 0.06}, Ring{0.14, 0.056, 0.058},  Ring{0.21, 0.056, 0.057},
                                         Ring{0.21, 0, 0}};
    constexpr std::array<Ring, 9> bare{Ring{0.10, 0.04, 0.042},  Ring{0.19, 0.042, 0.044}, Ring{0.28, 0.038, 0.040},
                                       Ring{0.34, 0.040, 0.042}, Ring{0.44, 0.033, 0.034}, Ring{0.54, 0.024, 0.028},
                                       Ring{0.60, 0.022, 0.042}, Ring{0.68, 0.018, 0.036}, Ring{0.735, 0, 0}};
    Placement const place{shoulder, rotation_about({0, 0, 1}, std::atan2(-arm.x, arm.y)), {1, 1, 1}};
    add_tube(parts.shirt, sleeve, 16, 18, {1, 2}, links, place);
    add_tube(parts.skin, bare, 14, 32, {1, 1}, links, place);
}

void add_leg(FigureParts& parts, int side) {
    D3 const hip = joint_place(joint_number(thigh, side));
    double const knee = hip.y - joint_place(joint_number(shin, side)).y;
    double const ankle = hip.y - joint_place(joint_number(foot, side)).y;
    std::array<Link, 4> const links{Link{joint_number(pelvis)}, Link{joint_number(thigh, side), 0, 0.06},
                                    Link{joint_number(shin, side), knee, 0.07},
                                    Link{joint_number(foot, side), ankle, 0.03}};
    constexpr std::array<Ring, 11> leg{Ring{-0.05, 0, 0},
                                       Ring{-0.03, 0.06, 0.07},
                                       Ring{0.04, 0.086, 0.096, -0.006},
                                       Ring{0.14, 0.085, 0.092},
                                       Ring{0.26, 0.075, 0.08, 0.004},
                                       Ring{0.38, 0.064, 0.068, 0.006},
                                       Ring{0.46, 0.06, 0.064, 0.002},
                                       Ring{0.56, 0.061, 0.066, -0.010},
                                       Ring{0.68, 0.056, 0.06, -0.006},
                                       Ring{0.80, 0.057, 0.064, 0.004},
                                       Ring{0.80, 0, 0}};
    constexpr std::array<Ring, 8> shoe{Ring{0, 0, 0, 0.05},
                                       Ring{0, 0.036, 0.115, 0.05},
                                       Ring{0.012, 0.047, 0.132, 0.05},
                                       Ring{0.04, 0.048, 0.128, 0.046},
                                       Ring{0.07, 0.044, 0.088, 0.014},
                                       Ring{0.10, 0.04, 0.056, -0.004},
                                       Ring{0.14, 0.04, 0.048, -0.004},
                                       Ring{0.14, 0, 0}};
    add_tube(parts.trousers, leg, 18, 40, {2, 5}, links, {hip, rotation_about({0, 0, 1}, pi), {1, 1, 1}});
    std::array<Link, 2> const collar{Link{joint_number(foot, side)}, Link{joint_number(shin, side), 0.12, 0.035}};
    add_tube(parts.shoes, shoe, 18, 14, {1, 1}, collar, {{hip.x, 0, hip.z}});
}

} // namespace

int parent_joint(int joint) {
    int const parent = form_of(joint).parent;
    return is_right(joint) && is_right(parent + joints_of_a_side) ? parent + joints_of_a_side : parent;
}

D3 joint_place(int joint) {
    return D3(is_right(joint) ? -1 : 1, 1, 1) * form_of(joint).place;
}

int add_figure_mesh(GltfDocument& document, FigureLook const& look) {
    FigureParts parts;
    add_trunk(parts);
    for (int side = 0; side < 2; ++side) {
        add_arm(parts, side);
        add_leg(parts, side);
    }
    auto const cloth = [&](char const* name, D3 color, std::string image) {
        return document.add_material({.name = name,
                                      .base_color = color,
                                      .roughness = 0.9,
                                      .base_color_texture = document.add_image(std::move(image))});
    };
    int const eyes = document.add_material({.name = "eyes", .base_color = D3(0.01), .roughness = 0.1});
    int const hair = document.add_material({.name = "hair", .base_color = look.hair, .roughness = 0.6});
    int const skin = document.add_material({.name = "skin", .base_color = look.skin, .roughness = 0.6});
    int const shoes = document.add_material({.name = "shoes", .base_color = look.shoes, .roughness = 0.4});
    return document.add_mesh("figure",
                             {{std::move(parts.shirt), cloth("shirt", look.shirt, stripe_texture())},
                              {std::move(parts.trousers), cloth("trousers", look.trousers, checker_texture())},
                              {std::move(parts.shoes), shoes},
                              {std::move(parts.skin), skin},
                              {std::move(parts.hair), hair},
                              {std::move(parts.eyes), eyes}});
}

Figure add_figure(GltfDocument& document, int mesh, Placement const& place, int parent) {
    Figure figure;
    GltfSkin skin;
    figure.root = document.add_node({.name = "figure", .place = place}, parent);
    for (int joint = 0; joint < figure_joints; ++joint) {
        int const carrier = parent_joint(joint);
        D3 const from = carrier == no_index ? D3(0) : joint_place(carrier);
        int const above = carrier == no_index ? figure.root : figure.joints.at(static_cast<std::size_t>(carrier));
        int const node = document.add_node({.name = form_of(joint).name, .place = {joint_place(joint) - from}}, above);
        figure.joints.at(static_cast<std::size_t>(joint)) = node;
        skin.joints.push_back(node);
        skin.places.push_back(joint_place(joint));
    }
    document.skins.push_back(std::move(skin));
    document.add_node({.name = "skin", .mesh = mesh, .skin = static_cast<int>(document.skins.size()) - 1});
    return figure;
}

} // namespace framelet
