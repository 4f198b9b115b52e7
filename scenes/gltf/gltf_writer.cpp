#include "scenes/gltf/gltf_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include <nlohmann/json.hpp>

#include "common/error.h"

namespace framelet {
namespace {

using Json = nlohmann::ordered_json;

constexpr int array_buffer = 34962;
constexpr int element_array_buffer = 34963;
constexpr int type_unsigned_byte = 5121;
constexpr int type_unsigned_short = 5123;
constexpr int type_unsigned_int = 5125;
constexpr int type_float = 5126;

constexpr double position_grid = 65536;
constexpr double value_grid = 1048576;

float on_grid(double value, double grid) {
    FRAMELET_CHECK(std::isfinite(value));
    return static_cast<float>(std::round(value * grid) / grid + 0.0); // + 0.0: no negative zero
}

std::uint8_t as_byte(double share) {
    return static_cast<std::uint8_t>(std::lround(share * 255));
}

Json numbers(std::initializer_list<double> values) {
    Json array = Json::array();
    for (double const value : values) {
        array.push_back(std::round(value * 1e6) / 1e6 + 0.0);
    }
    return array;
}

/// The binary chunk and the lists that say what lies where in it.
struct Binary {
    std::string bytes;
    Json views = Json::array();
    Json accessors = Json::array();
    std::map<std::pair<std::string, int>, int> known_views; // equal arrays are stored once

    int add_view(void const* data, std::size_t size, int target) {
        auto const [known, is_new] = known_views.try_emplace(
            {std::string(static_cast<char const*>(data), size), target}, static_cast<int>(views.size()));
        if (!is_new) {
            return known->second;
        }
        while (bytes.size() % 4 != 0) {
            bytes.push_back('\0');
        }
        Json view{{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}};
        if (target != 0) {
            view["target"] = target;
        }
        bytes.append(static_cast<char const*>(data), size);
        views.push_back(std::move(view));
        return known->second;
    }

    /// Adds an accessor of `components` floats an element; positions and key times must state their range.
    int add_floats(std::vector<float> const& values, int components, int target, bool with_range) {
        auto const width = static_cast<std::size_t>(components);
        Json accessor{{"bufferView", add_view(values.data(), values.size() * sizeof(float), target)},
                      {"componentType", type_float},
                      {"count", values.size() / width},
                      {"type", components == 1    ? "SCALAR"
                               : components == 16 ? "MAT4"
                                                  : "VEC" + std::to_string(components)}};
        if (with_range) {
            std::vector<float> lower(width, std::numeric_limits<float>::max());
            std::vector<float> upper(width, std::numeric_limits<float>::lowest());
            for (std::size_t i = 0; i < values.size(); ++i) {
                lower[i % width] = std::min(lower[i % width], values[i]);
                upper[i % width] = std::max(upper[i % width], values[i]);
            }
            accessor["min"] = lower;
            accessor["max"] = upper;
        }
        accessors.push_back(std::move(accessor));
        return static_cast<int>(accessors.size()) - 1;
    }

    int add_indices(std::vector<std::uint32_t> const& indices, std::size_t vertices) {
        bool const narrow = vertices < 65535;
        std::vector<std::uint16_t> shorts;
        if (narrow) {
            std::transform(indices.begin(), indices.end(), std::back_inserter(shorts),
                           [](std::uint32_t i) { return static_cast<std::uint16_t>(i); });
        }
        int const view = narrow ? add_view(shorts.data(), shorts.size() * 2, element_array_buffer)
                                : add_view(indices.data(), indices.size() * 4, element_array_buffer);
        accessors.push_back({{"bufferView", view},
                             {"componentType", narrow ? type_unsigned_short : type_unsigned_int},
                             {"count", indices.size()},
                             {"type", "SCALAR"}});
        return static_cast<int>(accessors.size()) - 1;
    }

    int add_vectors(std::vector<D3> const& vectors, double grid, bool with_range) {
        std::vector<float> values;
        for (D3 const& vector : vectors) {
            for (int c = 0; c < 3; ++c) {
                values.push_back(on_grid(vector[c], grid));
            }
        }
        return add_floats(values, 3, array_buffer, with_range);
    }

    int add_bytes(std::vector<std::uint8_t> const& values, bool normalized) {
        Json accessor{{"bufferView", add_view(values.data(), values.size(), array_buffer)},
                      {"componentType", type_unsigned_byte}};
        if (normalized) {
            accessor["normalized"] = true;
        }
        accessor["count"] = values.size() / 4;
        accessor["type"] = "VEC4";
        accessors.push_back(std::move(accessor));
        return static_cast<int>(accessors.size()) - 1;
    }

    int add_colors(std::vector<D3> const& colors) {
        std::vector<std::uint8_t> values;
        for (D3 const& color : colors) {
            for (int c = 0; c < 3; ++c) {
                values.push_back(as_byte(std::clamp(color[c], 0.0, 1.0)));
            }
            values.push_back(255);
        }
        return add_bytes(values, true);
    }
};

/// Adds JOINTS_0 and WEIGHTS_0. Weights are bytes that sum to 255 as they must; the strongest takes what rounding
/// leaves.
void write_joint_weights(Binary& binary, std::vector<JointWeights> const& joint_weights, Json& attributes) {
    std::vector<std::uint8_t> joints;
    std::vector<std::uint8_t> weights;
    for (JointWeights const& moved_by : joint_weights) {
        std::array<std::uint8_t, 4> shares{};
        std::transform(moved_by.weights.begin(), moved_by.weights.end(), shares.begin(), as_byte);
        int const sum = std::accumulate(shares.begin(), shares.end(), 0);
        FRAMELET_CHECK(std::abs(sum - 255) <= 2);
        auto const strongest = std::max_element(shares.begin(), shares.end());
        *strongest = static_cast<std::uint8_t>(*strongest + 255 - sum);
        for (std::size_t k = 0; k < shares.size(); ++k) {
            FRAMELET_CHECK(moved_by.joints[k] >= 0 && moved_by.joints[k] < 256);
            joints.push_back(shares[k] > 0 ? static_cast<std::uint8_t>(moved_by.joints[k]) : 0);
            weights.push_back(shares[k]);
        }
    }
    attributes["JOINTS_0"] = binary.add_bytes(joints, false);
    attributes["WEIGHTS_0"] = binary.add_bytes(weights, true);
}

Json write_target(Binary& binary, GltfMorphTarget const& target, std::size_t vertices) {
    FRAMELET_CHECK(target.positions.size() == vertices && target.normals.size() == vertices);
    return {{"POSITION", binary.add_vectors(target.positions, position_grid, true)},
            {"NORMAL", binary.add_vectors(target.normals, value_grid, false)}};
}

Json write_primitive(Binary& binary, GltfPrimitive const& primitive, bool textured) {
    MeshData const& mesh = primitive.data;
    FRAMELET_CHECK(!mesh.indices.empty() && mesh.normals.size() == mesh.positions.size());
    Json attributes{{"POSITION", binary.add_vectors(mesh.positions, position_grid, true)},
                    {"NORMAL", binary.add_vectors(mesh.normals, value_grid, false)}};
    if (textured) {
        FRAMELET_CHECK(mesh.uv.size() == mesh.positions.size());
        std::vector<float> uv;
        for (D2 const& t : mesh.uv) {
            uv.push_back(on_grid(t.x, value_grid));
            uv.push_back(on_grid(t.y, value_grid));
        }
        attributes["TEXCOORD_0"] = binary.add_floats(uv, 2, array_buffer, false);
    }
    if (!mesh.colors.empty()) {
        FRAMELET_CHECK(mesh.colors.size() == mesh.positions.size());
        attributes["COLOR_0"] = binary.add_colors(mesh.colors);
    }
    if (!mesh.joint_weights.empty()) {
        FRAMELET_CHECK(mesh.joint_weights.size() == mesh.positions.size());
        write_joint_weights(binary, mesh.joint_weights, attributes);
    }
    Json json{{"attributes", std::move(attributes)},
              {"indices", binary.add_indices(mesh.indices, mesh.positions.size())},
              {"material", primitive.material}};
    for (GltfMorphTarget const& target : primitive.targets) {
        json["targets"].push_back(write_target(binary, target, mesh.positions.size()));
    }
    return json;
}

/// The material as JSON; adds the glTF extensions that it uses to `extensions`.
Json write_material(GltfMaterial const& material, std::set<std::string>& extensions) {
    Json surface{
        {"baseColorFactor", numbers({material.base_color.x, material.base_color.y, material.base_color.z, 1.0})},
        {"metallicFactor", material.metallic},
        {"roughnessFactor", material.roughness}};
    if (material.base_color_texture != no_index) {
        surface["baseColorTexture"] = {{"index", material.base_color_texture}};
    }
    Json json{{"name", material.name}, {"pbrMetallicRoughness", std::move(surface)}};
    double const strongest = std::max({material.emissive.x, material.emissive.y, material.emissive.z});
    if (strongest > 0) {
        D3 const factor = material.emissive / std::max(strongest, 1.0);
        json["emissiveFactor"] = numbers({factor.x, factor.y, factor.z});
        if (strongest > 1) {
            extensions.insert("KHR_materials_emissive_strength");
            json["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strongest}};
        }
    }
    if (material.alpha_cutoff > 0) {
        json["alphaMode"] = "MASK";
        json["alphaCutoff"] = material.alpha_cutoff;
    }
    if (material.unlit) {
        extensions.insert("KHR_materials_unlit");
        json["extensions"]["KHR_materials_unlit"] = Json::object();
    }
    if (material.transmission > 0) {
        extensions.insert("KHR_materials_transmission");
        json["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", material.transmission}};
    }
    if (material.double_sided) {
        json["doubleSided"] = true;
    }
    return json;
}

Json write_node(GltfNode const& node) {
    Json json{{"name", node.name}};
    Placement const& place = node.place;
    if (place.translation != D3(0)) {
        json["translation"] = numbers({place.translation.x, place.translation.y, place.translation.z});
    }
    if (place.rotation != DQuat(1, 0, 0, 0)) {
        json["rotation"] = numbers({place.rotation.x, place.rotation.y, place.rotation.z, place.rotation.w});
    }
    if (place.scale != D3(1)) {
        json["scale"] = numbers({place.scale.x, place.scale.y, place.scale.z});
    }
    if (node.mesh != no_index) {
        json["mesh"] = node.mesh;
    }
    if (node.skin != no_index) {
        json["skin"] = node.skin;
    }
    if (node.camera != no_index) {
        json["camera"] = node.camera;
    }
    if (node.light != no_index) {
        json["extensions"]["KHR_lights_punctual"] = {{"light", node.light}};
    }
    if (!node.children.empty()) {
        json["children"] = node.children;
    }
    return json;
}

Json write_skin(Binary& binary, GltfSkin const& skin) {
    FRAMELET_CHECK(skin.joints.size() == skin.places.size());
    std::vector<float> matrices;
    for (D3 const& place : skin.places) {
        auto const back = [](double value) { return on_grid(-value, position_grid); };
        matrices.insert(matrices.end(),
                        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, back(place.x), back(place.y), back(place.z), 1});
    }
    return {{"inverseBindMatrices", binary.add_floats(matrices, 16, 0, false)}, {"joints", skin.joints}};
}

/// Numbers in a key of the track.
int width_of(GltfTrack const& track, GltfDocument const& document) {
    if (track.path == GltfPath::weights) {
        GltfNode const& node = document.nodes.at(static_cast<std::size_t>(track.nodes.at(0)));
        auto const targets = document.meshes.at(static_cast<std::size_t>(node.mesh)).primitives.at(0).targets.size();
        FRAMELET_CHECK(targets >= 1 && targets <= 4);
        return static_cast<int>(targets);
    }
    return track.path == GltfPath::rotation ? 4 : 3;
}

Json write_animation(Binary& binary, GltfDocument const& document) {
    static constexpr std::array names{"translation", "rotation", "weights"}; // by GltfPath
    Json channels = Json::array();
    Json samplers = Json::array();
    for (GltfTrack const& track : document.tracks) {
        FRAMELET_CHECK(track.times.size() == track.values.size() && !track.times.empty());
        int const width = width_of(track, document);
        std::vector<float> times;
        std::vector<float> values;
        for (std::size_t key = 0; key < track.times.size(); ++key) {
            times.push_back(on_grid(track.times[key], value_grid));
            FRAMELET_CHECK(key == 0 || times[key] > times[key - 1]);
            for (int c = 0; c < width; ++c) {
                values.push_back(
                    on_grid(track.values[key][c], track.path == GltfPath::translation ? position_grid : value_grid));
            }
        }
        int const components = track.path == GltfPath::weights ? 1 : width; // of an element of the accessor
        samplers.push_back({{"input", binary.add_floats(times, 1, 0, true)},
                            {"output", binary.add_floats(values, components, 0, false)},
                            {"interpolation", track.step ? "STEP" : "LINEAR"}});
        char const* const path = names.at(static_cast<std::size_t>(track.path));
        for (int const node : track.nodes) {
            channels.push_back({{"sampler", samplers.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
        }
    }
    return {{"name", "clip"}, {"channels", std::move(channels)}, {"samplers", std::move(samplers)}};
}

Json root_nodes(GltfDocument const& document) {
    std::set<int> children;
    for (GltfNode const& node : document.nodes) {
        children.insert(node.children.begin(), node.children.end());
    }
    Json roots = Json::array();
    for (int i = 0; i < static_cast<int>(document.nodes.size()); ++i) {
        if (!children.contains(i)) {
            roots.push_back(i);
        }
    }
    return roots;
}

Json write_lights(std::vector<GltfLight> const& lights) {
    Json list = Json::array();
    for (GltfLight const& light : lights) {
        list.push_back({{"type", light.type},
                        {"color", numbers({light.color.x, light.color.y, light.color.z})},
                        {"intensity", light.intensity}});
    }
    return list;
}

void write_word(std::string& out, std::size_t value) {
    for (int byte = 0; byte < 4; ++byte) {
        out.push_back(static_cast<char>((value >> (8 * byte)) & 0xff));
    }
}

} // namespace

std::string write_glb(GltfDocument const& document) {
    Binary binary;
    Json json;
    json["asset"] = {{"version", "2.0"}, {"generator", "framelet-scenes"}};
    if (!document.light.empty()) {
        json["asset"]["extras"]["framelet_light"] = document.light;
    }
    std::set<std::string> extensions;
    json["scene"] = 0;
    json["scenes"] = Json::array({Json{{"name", document.name}, {"nodes", root_nodes(document)}}});
    for (GltfNode const& node : document.nodes) {
        json["nodes"].push_back(write_node(node));
    }
    for (GltfMesh const& mesh : document.meshes) {
        Json primitives = Json::array();
        for (GltfPrimitive const& primitive : mesh.primitives) {
            GltfMaterial const& material = document.materials.at(static_cast<std::size_t>(primitive.material));
            primitives.push_back(write_primitive(binary, primitive, material.base_color_texture != no_index));
        }
        json["meshes"].push_back({{"name", mesh.name}, {"primitives", std::move(primitives)}});
    }
    for (GltfSkin const& skin : document.skins) {
        json["skins"].push_back(write_skin(binary, skin));
    }
    for (GltfMaterial const& material : document.materials) {
        json["materials"].push_back(write_material(material, extensions));
    }
    for (std::string const& image : document.images) {
        json["images"].push_back(
            {{"bufferView", binary.add_view(image.data(), image.size(), 0)}, {"mimeType", "image/png"}});
        json["textures"].push_back({{"source", json["images"].size() - 1}, {"sampler", 0}});
    }
    if (!document.images.empty()) {
        json["samplers"] =
            Json::array({Json{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}}});
    }
    for (GltfCamera const& camera : document.cameras) {
        json["cameras"].push_back({{"name", camera.name},
                                   {"type", "perspective"},
                                   {"perspective", {{"yfov", camera.vertical_fov}, {"znear", 0.05}, {"zfar", 5000}}}});
    }
    if (!document.tracks.empty()) {
        json["animations"] = Json::array({write_animation(binary, document)});
    }
    if (!document.lights.empty()) {
        json["extensions"]["KHR_lights_punctual"]["lights"] = write_lights(document.lights);
        extensions.insert("KHR_lights_punctual");
    }
    if (!extensions.empty()) {
        json["extensionsUsed"] = extensions;
    }
    binary.bytes.resize((binary.bytes.size() + 3) / 4 * 4, '\0');
    json["buffers"] = Json::array({Json{{"byteLength", binary.bytes.size()}}});
    json["bufferViews"] = std::move(binary.views);
    json["accessors"] = std::move(binary.accessors);

    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string out = "glTF";
    write_word(out, 2);
    write_word(out, 12 + 8 + text.size() + 8 + binary.bytes.size());
    write_word(out, text.size());
    out += "JSON" + text;
    write_word(out, binary.bytes.size());
    out += std::string("BIN\0", 4) + binary.bytes;
    return out;
}

} // namespace framelet
