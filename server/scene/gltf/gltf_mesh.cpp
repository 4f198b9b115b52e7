#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include <tiny_gltf.h>

#include "common/error.h"
#include "server/scene/gltf/gltf_accessor.h"
#include "server/scene/gltf/gltf_parts.h"

namespace framelet {
namespace {

/// Turns the vertex order of triangles, strips and fans into a triangle list (glTF 2.0 section 3.7.2.1).
std::vector<std::array<std::uint32_t, 3>> make_triangles(std::vector<std::uint32_t> const& order, int mode) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::size_t const n = order.size();
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        triangles.reserve(n / 3);
        for (std::size_t i = 0; i + 2 < n; i += 3) {
            triangles.push_back({order[i], order[i + 1], order[i + 2]});
        }
    } else {
        for (std::size_t i = 0; i + 2 < n; ++i) {
            if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
                triangles.push_back({order[i + 1], order[i + 2], order[0]});
            } else {
                triangles.push_back({order[i], order[i + 1 + i % 2], order[i + 2 - i % 2]});
            }
        }
    }
    return triangles;
}

struct PrimitiveReader {
    GltfAccessors const& accessors;
    std::map<std::string, int> const& attributes;
    std::size_t vertex_count;

    bool has(std::string const& name) const { return attributes.contains(name); }

    /// The attribute's accessor; throws where its length is not the number of vertices.
    int accessor(std::string const& name) const {
        int const index = attributes.at(name);
        std::size_t const count = accessors.count(index);
        if (count != vertex_count) {
            throw InputError("attribute " + name + " has " + std::to_string(count) + " entries for " +
                             std::to_string(vertex_count) + " vertices");
        }
        return index;
    }

    template <class T>
    std::vector<T> read(std::string const& name) const {
        return has(name) ? accessors.read<T>(accessor(name)) : std::vector<T>();
    }

    std::vector<Vec4> read_colors() const {
        if (!has("COLOR_0") || accessors.components(accessor("COLOR_0")) == 4) {
            return read<Vec4>("COLOR_0");
        }
        std::vector<Vec4> colors;
        for (Vec3 const& color : read<Vec3>("COLOR_0")) {
            colors.emplace_back(color, 1);
        }
        return colors;
    }

    /// The four strongest of the up to eight influences of every vertex.
    std::vector<JointInfluence> read_influences() const {
        std::vector<std::array<std::pair<float, std::uint32_t>, 8>> all(
            has("JOINTS_0") && has("WEIGHTS_0") ? vertex_count : 0);
        for (std::size_t set = 0; set < 2 && !all.empty(); ++set) {
            std::string const suffix = std::to_string(set);
            if (!has("JOINTS_" + suffix) || !has("WEIGHTS_" + suffix)) {
                break;
            }
            auto const joints = accessors.read_integers(accessor("JOINTS_" + suffix), 4);
            auto const weights = read<Vec4>("WEIGHTS_" + suffix);
            for (std::size_t i = 0; i < vertex_count; ++i) {
                for (int k = 0; k < 4; ++k) {
                    float const weight = weights[i][k];
                    auto const c = static_cast<std::size_t>(k);
                    all[i][set * 4 + c] = {std::isfinite(weight) ? weight : 0, joints[i * 4 + c]};
                }
            }
        }
        std::vector<JointInfluence> influences(all.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            std::stable_sort(all[i].begin(), all[i].end(),
                             [](auto const& a, auto const& b) { return a.first > b.first; });
            for (std::size_t k = 0; k < 4; ++k) {
                auto const [weight, joint] = all[i][k];
                if (weight > 0 && joint > 0xffff) {
                    throw InputError("joint " + std::to_string(joint) + " does not exist");
                }
                influences[i].weights[k] = weight;
                influences[i].joints[k] = static_cast<std::uint16_t>(weight > 0 ? joint : 0);
            }
        }
        return influences;
    }
};

Primitive import_primitive(GltfAccessors const& accessors, tinygltf::Primitive const& from) {
    auto const position = from.attributes.find("POSITION");
    PrimitiveReader const reader{accessors, from.attributes, accessors.count(position->second)};
    Primitive primitive;
    primitive.material = from.material;
    primitive.positions = reader.read<Vec3>("POSITION");
    primitive.normals = reader.read<Vec3>("NORMAL");
    primitive.tangents = reader.read<Vec4>("TANGENT");
    primitive.uv = {reader.read<Vec2>("TEXCOORD_0"), reader.read<Vec2>("TEXCOORD_1")};
    primitive.colors = reader.read_colors();
    primitive.influences = reader.read_influences();
    for (std::map<std::string, int> const& target : from.targets) {
        PrimitiveReader const offsets{accessors, target, reader.vertex_count};
        primitive.morph_targets.push_back(
            {offsets.read<Vec3>("POSITION"), offsets.read<Vec3>("NORMAL"), offsets.read<Vec3>("TANGENT")});
    }
    std::vector<std::uint32_t> order;
    if (from.indices >= 0) {
        order = accessors.read_integers(from.indices, 1);
        for (std::uint32_t const index : order) {
            if (index >= reader.vertex_count) {
                throw InputError("vertex index " + std::to_string(index) + " is out of range: there are " +
                                 std::to_string(reader.vertex_count) + " vertices");
            }
        }
    } else {
        order.resize(reader.vertex_count);
        std::iota(order.begin(), order.end(), 0u);
    }
    primitive.triangles = make_triangles(order, from.mode);
    return primitive;
}

bool is_surface(int mode) {
    return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
           mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

} // namespace

void reserve_gltf_mesh(tinygltf::Model const& model, GltfAccessors const& accessors, std::size_t index,
                       ImportBudget& budget) {
    for (tinygltf::Primitive const& primitive : model.meshes[index].primitives) {
        auto const position = primitive.attributes.find("POSITION");
        if (!is_surface(primitive.mode) || position == primitive.attributes.end()) {
            continue;
        }
        std::size_t vertex_bytes = 0;
        auto const add = [&](std::map<std::string, int> const& attributes) {
            for (auto const& [name, accessor] : attributes) {
                vertex_bytes += static_cast<std::size_t>(std::max(accessors.components(accessor), 0)) * sizeof(float);
            }
        };
        add(primitive.attributes);
        std::for_each(primitive.targets.begin(), primitive.targets.end(), add);
        std::size_t const vertices = accessors.count(position->second);
        std::size_t const corners = primitive.indices >= 0 ? accessors.count(primitive.indices) : vertices;
        budget.reserve(vertices, vertex_bytes);
        budget.reserve(corners, sizeof(std::uint32_t));
        if (!primitive.attributes.contains("NORMAL")) { // flat shading gives every corner its own vertex
            budget.reserve(corners, vertex_bytes + sizeof(Vec3));
        }
    }
}

Mesh import_gltf_mesh(tinygltf::Model const& model, GltfAccessors const& accessors, std::size_t index,
                      std::vector<std::string>& warnings) {
    tinygltf::Mesh const& from = model.meshes[index];
    std::string const what = "mesh " + std::to_string(index) + (from.name.empty() ? "" : " '" + from.name + "'");
    Mesh mesh;
    mesh.name = from.name;
    for (double const weight : from.weights) {
        mesh.morph_weights.push_back(static_cast<float>(weight));
    }
    for (tinygltf::Primitive const& primitive : from.primitives) {
        if (!is_surface(primitive.mode)) {
            warnings.push_back(what + ": points and lines are not shown");
        } else if (!primitive.attributes.contains("POSITION")) {
            warnings.push_back(what + ": a primitive without positions is not shown");
        } else {
            try {
                mesh.primitives.push_back(import_primitive(accessors, primitive));
            } catch (InputError const& error) {
                throw InputError(what + ": " + error.what());
            }
        }
    }
    return mesh;
}

} // namespace framelet
