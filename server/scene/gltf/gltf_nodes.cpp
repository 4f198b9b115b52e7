#include <glm/gtc/type_ptr.hpp>

#include "common/error.h"
#include "server/scene/gltf/gltf_accessor.h"
#include "server/scene/gltf/gltf_parts.h"
#include "server/scene/gltf/gltf_value.h"

namespace framelet {
namespace {

/// `index` where it names one of `count` things, else an InputError.
std::size_t checked(int index, std::size_t count, std::string const& what) {
    if (index < 0 || static_cast<std::size_t>(index) >= count) {
        throw InputError(what + " " + std::to_string(index) + " does not exist");
    }
    return static_cast<std::size_t>(index);
}

/// The nodes that the default scene starts from; all that nobody has as a child where the file has no scene.
std::vector<int> root_nodes(tinygltf::Model const& model) {
    if (!model.scenes.empty()) {
        int const index = model.defaultScene < 0 ? 0 : model.defaultScene;
        return model.scenes[checked(index, model.scenes.size(), "scene")].nodes;
    }
    std::vector<bool> is_child(model.nodes.size());
    for (tinygltf::Node const& node : model.nodes) {
        for (int const child : node.children) {
            is_child[checked(child, model.nodes.size(), "node")] = true;
        }
    }
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i) {
        if (!is_child[i]) {
            roots.push_back(static_cast<int>(i));
        }
    }
    if (roots.empty() && !model.nodes.empty()) {
        throw InputError("its nodes form a cycle");
    }
    return roots;
}

Node make_node(tinygltf::Node const& from, Index parent) {
    Node node;
    node.name = from.name;
    node.parent = parent;
    if (from.matrix.size() == 16) {
        node.matrix = glm::make_mat4(from.matrix.data());
    }
    Vec4 const rotation = vec4(from.rotation, {0, 0, 0, 1});
    if (from.translation.size() == 3) {
        node.local.translation = glm::make_vec3(from.translation.data());
    }
    node.local.rotation = Quat(rotation.w, rotation.x, rotation.y, rotation.z);
    node.local.scale = vec3(from.scale, node.local.scale);
    for (double const weight : from.weights) {
        node.morph_weights.push_back(static_cast<float>(weight));
    }
    return node;
}

void add_camera(tinygltf::Model const& model, int index, Index node, Scene& scene) {
    tinygltf::Camera const& from = model.cameras[checked(index, model.cameras.size(), "camera")];
    SceneCamera camera;
    camera.name = from.name.empty() ? scene.nodes[static_cast<std::size_t>(node)].name : from.name;
    camera.node = node;
    if (from.type == "orthographic") {
        camera.projection = Projection::orthographic;
        camera.vertical_extent = static_cast<float>(2 * std::abs(from.orthographic.ymag));
    } else {
        camera.vertical_extent = static_cast<float>(from.perspective.yfov);
    }
    scene.cameras.push_back(camera);
}

void add_light(tinygltf::Model const& model, int index, Index node, Scene& scene) {
    tinygltf::Light const& from = model.lights[checked(index, model.lights.size(), "light")];
    Light light;
    if (from.type != "directional" && from.type != "point" && from.type != "spot") {
        scene.warnings.push_back("light " + std::to_string(index) + " is of the unknown type '" + from.type +
                                 "' and passed over");
        return;
    }
    light.type = from.type == "directional" ? LightType::directional
                 : from.type == "spot"      ? LightType::spot
                                            : LightType::point;
    light.name = from.name;
    light.node = node;
    light.color = vec3(from.color, light.color);
    light.intensity = static_cast<float>(from.intensity);
    light.range = static_cast<float>(from.range);
    light.inner_cone = static_cast<float>(from.spot.innerConeAngle);
    light.outer_cone = static_cast<float>(from.spot.outerConeAngle);
    scene.lights.push_back(light);
}

void import_skins(tinygltf::Model const& model, GltfAccessors const& accessors, GltfMapping const& mapping,
                  Scene& scene) {
    for (std::size_t i = 0; i < model.skins.size(); ++i) {
        tinygltf::Skin const& from = model.skins[i];
        Skin skin;
        for (int const joint : from.joints) {
            skin.joints.push_back(mapping.node[checked(joint, model.nodes.size(), "joint node")]);
        }
        if (from.inverseBindMatrices >= 0) {
            skin.inverse_bind_matrices = accessors.read<Mat4>(from.inverseBindMatrices);
            if (skin.inverse_bind_matrices.size() < skin.joints.size()) {
                throw InputError("skin " + std::to_string(i) + " has fewer inverse bind matrices than joints");
            }
        }
        skin.inverse_bind_matrices.resize(skin.joints.size(), Mat4(1));
        scene.skins.push_back(std::move(skin));
    }
}

} // namespace

GltfMapping import_gltf_nodes(tinygltf::Model const& model, GltfAccessors const& accessors, Scene& scene) {
    GltfMapping mapping;
    mapping.node.assign(model.nodes.size(), none);
    std::vector<Index> mesh_in_scene(model.meshes.size(), none);
    struct Pending {
        int node;
        Index parent;
    };
    std::vector<Pending> pending;
    std::vector<int> const roots = root_nodes(model);
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
        pending.push_back({*root, none});
    }
    while (!pending.empty()) {
        Pending const next = pending.back();
        pending.pop_back();
        std::size_t const file_index = checked(next.node, model.nodes.size(), "node");
        tinygltf::Node const& from = model.nodes[file_index];
        if (mapping.node[file_index] != none) {
            throw InputError("node " + std::to_string(file_index) +
                             " is reached twice: it is in a cycle or has two parents");
        }
        auto const index = static_cast<Index>(scene.nodes.size());
        mapping.node[file_index] = index;
        Node node = make_node(from, next.parent);
        if (from.mesh >= 0) {
            std::size_t const mesh = checked(from.mesh, model.meshes.size(), "mesh");
            if (mesh_in_scene[mesh] == none) {
                mesh_in_scene[mesh] = static_cast<Index>(mapping.used_meshes.size());
                mapping.used_meshes.push_back(mesh);
            }
            node.mesh = mesh_in_scene[mesh];
            node.skin = from.skin < 0 ? none : static_cast<Index>(checked(from.skin, model.skins.size(), "skin"));
        }
        scene.nodes.push_back(std::move(node));
        if (from.camera >= 0) {
            add_camera(model, from.camera, index, scene);
        }
        if (tinygltf::Value const* light = find_extension(from.extensions, "KHR_lights_punctual")) {
            add_light(model, integer(*light, "light", none), index, scene);
        }
        for (auto child = from.children.rbegin(); child != from.children.rend(); ++child) {
            pending.push_back({*child, index});
        }
    }
    import_skins(model, accessors, mapping, scene);
    return mapping;
}

} // namespace framelet
