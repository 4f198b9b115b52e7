#include <algorithm>
#include <utility>

#include "server/scene/gltf/gltf_accessor.h"
#include "server/scene/gltf/gltf_parts.h"
#include "server/scene/reading/faults.h"

namespace framelet {
namespace {

/// A node that is to be imported.
struct Pending {
    std::size_t node; ///< in the file
    Index parent; ///< likewise; `none` for a root
    bool hidden; ///< by KHR_node_visibility of a node above it
};

std::string name_of(Json const& json, std::size_t node) {
    return named("node", node, text(list(json, "nodes")[node], "name"));
}

/// Those of the listed nodes that exist.
std::vector<std::size_t> existing(Json::array_t const& listed, std::size_t count, Faults const& faults) {
    std::vector<std::size_t> out;
    for (Json const& node : listed) {
        faults.tried([&] { out.push_back(checked(node, count, "node")); }, "");
    }
    return out;
}

/// All nodes that nobody has as a child.
std::vector<std::size_t> parentless(Json const& json) {
    Json::array_t const& nodes = list(json, "nodes");
    std::vector<bool> is_child(nodes.size());
    std::vector<std::string> said_later;
    for (Json const& node : nodes) {
        for (std::size_t const child : existing(list(node, "children"), nodes.size(), {"", said_later})) {
            is_child[child] = true;
        }
    }
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i) {
        if (!is_child[i]) {
            roots.push_back(i);
        }
    }
    if (roots.empty() && !nodes.empty()) {
        throw InputError("its nodes form a cycle: each of them is below another");
    }
    return roots;
}

/// Throws InputError where a node that has been reached from `first` is reached again: by whom, and why that is wrong.
[[noreturn]] void refuse_second_place(Json const& json, Pending const& again, std::vector<Index> const& parent) {
    std::string const name = name_of(json, again.node);
    for (Index above = again.parent; above != none; above = parent[static_cast<std::size_t>(above)]) {
        if (static_cast<std::size_t>(above) == again.node) {
            throw InputError(name + " is below itself: the nodes of a scene must form a tree");
        }
    }
    auto const place = [&](Index by) {
        return by == none ? std::string("in the list of the scene")
                          : "as a child of " + name_of(json, static_cast<std::size_t>(by));
    };
    throw InputError(name + " is reached twice: " + place(parent[again.node]) + " and " + place(again.parent) +
                     "; the nodes of a scene must form a tree");
}

Node make_node(Json const& from, Index parent, Faults const& faults) {
    Node node;
    node.name = text(from, "name");
    node.parent = parent;
    auto const read = [&](char const* key, auto& out) {
        faults.tried([&] { read_numbers(from, key, out); }, "; it is passed over");
    };
    if (!member(from, "matrix").is_null()) {
        glm::dmat4 matrix(1);
        read("matrix", matrix);
        node.matrix = matrix;
    }
    Vec4 rotation(0, 0, 0, 1);
    read("rotation", rotation);
    node.local.rotation = Quat(rotation.w, rotation.x, rotation.y, rotation.z);
    read("translation", node.local.translation);
    read("scale", node.local.scale);
    node.morph_weights = floats(from, "weights");
    return node;
}

SceneCamera make_camera(Json const& from, Index node, Scene const& scene) {
    SceneCamera camera;
    camera.name = text(from, "name");
    if (camera.name.empty()) {
        camera.name = scene.nodes[static_cast<std::size_t>(node)].name;
    }
    camera.node = node;
    if (text(from, "type") == "orthographic") {
        camera.projection = Projection::orthographic;
        camera.vertical_extent = static_cast<float>(2 * std::abs(number(member(from, "orthographic"), "ymag", 0)));
    } else {
        camera.vertical_extent = static_cast<float>(number(member(from, "perspective"), "yfov", 0));
    }
    return camera;
}

/// Throws InputError where nobody knows what light that is.
Light make_light(Json const& from, Index node, Faults const& faults) {
    Light light;
    std::string const type = text(from, "type");
    if (type != "directional" && type != "point" && type != "spot") {
        throw InputError("a light of the unknown type '" + type + "' is passed over");
    }
    light.type = type == "directional" ? LightType::directional : type == "spot" ? LightType::spot : LightType::point;
    light.name = text(from, "name");
    light.node = node;
    faults.tried([&] { read_numbers(from, "color", light.color); }, "; the light is white");
    light.intensity = static_cast<float>(number(from, "intensity", light.intensity));
    light.range = static_cast<float>(number(from, "range", light.range));
    Json const& spot = member(from, "spot");
    light.inner_cone = static_cast<float>(number(spot, "innerConeAngle", light.inner_cone));
    light.outer_cone = static_cast<float>(number(spot, "outerConeAngle", light.outer_cone));
    return light;
}

Skin make_skin(Json const& from, GltfAccessors const& accessors, GltfMapping const& mapping) {
    Skin skin;
    for (Json const& joint : list(from, "joints")) {
        skin.joints.push_back(mapping.node[checked(joint, mapping.node.size(), "joint node")]);
    }
    if (skin.joints.empty()) {
        throw InputError("it has no joints");
    }
    if (Index const matrices = index(from, "inverseBindMatrices"); matrices != none) {
        skin.inverse_bind_matrices = accessors.read<Mat4>(matrices);
        if (skin.inverse_bind_matrices.size() < skin.joints.size()) {
            throw InputError("it has fewer inverse bind matrices than joints");
        }
    }
    skin.inverse_bind_matrices.resize(skin.joints.size(), Mat4(1));
    return skin;
}

/// The places of instances of a mesh in its node (EXT_mesh_gpu_instancing).
std::vector<Transform> read_instances(Json const& attributes, GltfAccessors const& accessors) {
    auto const read = [&]<typename T>(char const* key, T const&) {
        Index const accessor = index(attributes, key);
        return accessor == none ? std::vector<T>() : accessors.read<T>(accessor);
    };
    std::vector<Vec3> const translations = read("TRANSLATION", Vec3());
    std::vector<Vec4> const rotations = read("ROTATION", Vec4());
    std::vector<Vec3> const scales = read("SCALE", Vec3());
    std::size_t const count = std::max({translations.size(), rotations.size(), scales.size()});
    for (auto const& [has, what] : {std::pair(translations.size(), " translations"),
                                    std::pair(rotations.size(), " rotations"), std::pair(scales.size(), " scales")}) {
        if (has != 0 && has != count) {
            throw InputError("it has " + std::to_string(count) + " instances, but " + std::to_string(has) + what);
        }
    }
    std::vector<Transform> out(count);
    for (std::size_t i = 0; i < count; ++i) {
        out[i].translation = translations.empty() ? Vec3(0) : translations[i];
        out[i].scale = scales.empty() ? Vec3(1) : scales[i];
        if (!rotations.empty()) {
            out[i].rotation = Quat(rotations[i].w, rotations[i].x, rotations[i].y, rotations[i].z);
        }
    }
    return out;
}

/// Imports what a node has besides its place.
class NodeContent {
public:
    NodeContent(Json const& json, GltfAccessors const& accessors, ImportBudget& budget, GltfMapping& mapping,
                Scene& scene)
        : json_(json), accessors_(accessors), budget_(budget), mapping_(mapping), scene_(scene),
          mesh_in_scene_(list(json, "meshes").size(), none) {}

    /// `node`: the file's node, and its place in the scene, which is the last so far.
    void import(Json const& from, Index node, bool hidden, Faults const& faults) {
        if (Json const& mesh = member(from, "mesh"); !mesh.is_null() && !hidden) {
            faults.tried([&] { import_mesh(mesh, member(from, "skin"), node, faults); }, "");
            Json const& instancing = extension(from, "EXT_mesh_gpu_instancing");
            faults.tried([&] { import_instances(member(instancing, "attributes"), node); }, "; it is shown once");
        }
        if (Json const& camera = member(from, "camera"); !camera.is_null()) {
            Json::array_t const& cameras = list(json_, "cameras");
            faults.tried(
                [&] {
                    scene_.cameras.push_back(
                        make_camera(cameras[checked(camera, cameras.size(), "camera")], node, scene_));
                },
                "");
        }
        if (Json const& light = extension(from, "KHR_lights_punctual"); !light.is_null() && !hidden) {
            Json::array_t const& lights = list(extension(json_, "KHR_lights_punctual"), "lights");
            faults.tried(
                [&] {
                    scene_.lights.push_back(
                        make_light(lights[checked(member(light, "light"), lights.size(), "light")], node, faults));
                },
                "");
        }
    }

private:
    void import_mesh(Json const& from, Json const& skin, Index node, Faults const& faults) {
        std::size_t const mesh = checked(from, mesh_in_scene_.size(), "mesh");
        if (mesh_in_scene_[mesh] == none) {
            mesh_in_scene_[mesh] = static_cast<Index>(mapping_.used_meshes.size());
            mapping_.used_meshes.push_back(mesh);
        }
        Node& to = scene_.nodes[static_cast<std::size_t>(node)];
        to.mesh = mesh_in_scene_[mesh];
        if (!skin.is_null()) {
            faults.tried([&] { to.skin = static_cast<Index>(checked(skin, list(json_, "skins").size(), "skin")); },
                         "; it is shown without it");
        }
    }

    /// Gives the mesh of the node to a child of it for each instance.
    void import_instances(Json const& attributes, Index node) {
        std::vector<Transform> const places = read_instances(attributes, accessors_);
        constexpr std::uint64_t node_bytes = 4 * sizeof(Node); // it, and what rendering makes of it
        budget_.reserve(places.size(), node_bytes);
        for (Transform const& place : places) {
            Node instance = scene_.nodes[static_cast<std::size_t>(node)];
            instance.name.clear();
            instance.parent = node;
            instance.local = place;
            instance.matrix.reset();
            scene_.nodes.push_back(std::move(instance));
        }
        if (!places.empty()) {
            scene_.nodes[static_cast<std::size_t>(node)].mesh = none;
        }
    }

    Json const& json_;
    GltfAccessors const& accessors_;
    ImportBudget& budget_;
    GltfMapping& mapping_;
    Scene& scene_;
    std::vector<Index> mesh_in_scene_; ///< by the file's indices
};

} // namespace

GltfMapping import_gltf_nodes(Json const& json, std::size_t chosen, GltfAccessors const& accessors,
                              ImportBudget& budget, Scene& scene, std::vector<std::string>& faults) {
    Json::array_t const& nodes = list(json, "nodes");
    Json::array_t const& scenes = list(json, "scenes");
    GltfMapping mapping;
    mapping.node.assign(nodes.size(), none);
    NodeContent content(json, accessors, budget, mapping, scene);
    std::vector<Index> parent(nodes.size(), none); // in the file, of nodes that are in the scene
    std::vector<Pending> pending;
    auto const reach = [&](std::vector<std::size_t> const& children, Index from, bool hidden) {
        for (auto child = children.rbegin(); child != children.rend(); ++child) {
            pending.push_back({*child, from, hidden});
        }
    };
    reach(scenes.empty() ? parentless(json)
                         : existing(list(scenes[chosen], "nodes"), nodes.size(),
                                    {named("scene", chosen, text(scenes[chosen], "name")), faults}),
          none, false);
    while (!pending.empty()) {
        Pending const next = pending.back();
        pending.pop_back();
        if (mapping.node[next.node] != none) {
            refuse_second_place(json, next, parent);
        }
        Json const& from = nodes[next.node];
        std::string const name = name_of(json, next.node);
        if (!from.is_object()) {
            faults.push_back(name + " is not an object");
            continue;
        }
        Faults const of_node(name, faults);
        auto const index = static_cast<Index>(scene.nodes.size());
        mapping.node[next.node] = index;
        parent[next.node] = next.parent;
        scene.nodes.push_back(
            make_node(from, next.parent == none ? none : mapping.node[static_cast<std::size_t>(next.parent)], of_node));
        bool const hidden = next.hidden || !flag(extension(from, "KHR_node_visibility"), "visible", true);
        content.import(from, index, hidden, of_node);
        reach(existing(list(from, "children"), nodes.size(), of_node), static_cast<Index>(next.node), hidden);
    }
    Json::array_t const& skins = list(json, "skins");
    for (std::size_t i = 0; i < skins.size(); ++i) {
        Skin& skin = scene.skins.emplace_back();
        Faults(named("skin", i, text(skins[i], "name")), faults)
            .tried([&] { skin = make_skin(skins[i], accessors, mapping); }, "; what it moves is shown without it");
    }
    return mapping;
}

} // namespace framelet
