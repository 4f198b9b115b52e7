#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "server/scene/gltf/gltf_accessor.h"
#include "server/scene/gltf/gltf_compression.h"
#include "server/scene/gltf/gltf_parts.h"
#include "server/scene/reading/faults.h"

namespace framelet {
namespace {

/// Modes of a primitive (glTF 2.0 section 5.24.4); those below are points and lines, the one between is strips.
constexpr std::uint64_t triangles_mode = 4, fan_mode = 6;

/// Turns the vertex order of triangles, strips and fans into a triangle list (glTF 2.0 section 3.7.2.1).
std::vector<std::array<std::uint32_t, 3>> make_triangles(std::vector<std::uint32_t> const& order, std::uint64_t mode) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::size_t const n = order.size();
    if (mode == triangles_mode) {
        triangles.reserve(n / 3);
        for (std::size_t i = 0; i + 2 < n; i += 3) {
            triangles.push_back({order[i], order[i + 1], order[i + 2]});
        }
    } else {
        for (std::size_t i = 0; i + 2 < n; ++i) {
            if (mode == fan_mode) {
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
    Json const& attributes;
    std::size_t vertex_count;
    DracoMesh const* draco = nullptr; ///< has some of the attributes, where there is one

    bool is_in_draco(std::string const& name) const { return draco && draco->has(name); }

    bool has(std::string const& name) const { return !member(attributes, name.c_str()).is_null(); }

    /// The attribute's accessor; throws where its length is not the number of vertices.
    Index accessor(std::string const& name) const {
        Index const place = index(attributes, name.c_str());
        std::size_t const count = accessors.count(place);
        if (count != vertex_count) {
            throw InputError("attribute " + name + " has " + std::to_string(count) + " entries for " +
                             std::to_string(vertex_count) + " vertices");
        }
        return place;
    }

    template <class T>
    std::vector<T> read(std::string const& name) const {
        constexpr std::size_t width = sizeof(T) / sizeof(float);
        if (has(name) && is_in_draco(name)) {
            accessors.budget().reserve(vertex_count, sizeof(T));
            std::vector<T> values(vertex_count);
            draco->read(name, accessors.is_normalized(index(attributes, name.c_str())), width,
                        reinterpret_cast<float*>(values.data()));
            return values;
        }
        return has(name) ? accessors.read<T>(accessor(name)) : std::vector<T>();
    }

    std::size_t components(std::string const& name) const {
        return is_in_draco(name) ? draco->components(name) : accessors.components(accessor(name));
    }

    std::vector<std::uint32_t> read_joints(std::string const& name) const {
        constexpr std::size_t width = 4;
        if (!is_in_draco(name)) {
            return accessors.read_integers(accessor(name), width);
        }
        accessors.budget().reserve(vertex_count, width * sizeof(std::uint32_t));
        return draco->read_integers(name, width);
    }

    std::vector<Vec4> read_colors() const {
        if (!has("COLOR_0") || components("COLOR_0") == 4) {
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
            auto const joints = read_joints("JOINTS_" + suffix);
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

/// The mesh that has some of a primitive's attributes (KHR_draco_mesh_compression); nothing where there is none.
std::optional<DracoMesh> draco_mesh(GltfAccessors const& accessors, Json const& primitive) {
    Json const& compressed = extension(primitive, "KHR_draco_mesh_compression");
    return compressed.is_null()
               ? std::nullopt
               : std::optional<DracoMesh>(std::in_place, accessors.view(index(compressed, "bufferView")),
                                          member(compressed, "attributes"));
}

/// The vertices of a primitive, in the order in which its triangles use them.
std::vector<std::uint32_t> read_order(GltfAccessors const& accessors, Json const& from, DracoMesh const* draco,
                                      std::size_t vertex_count) {
    std::vector<std::uint32_t> order;
    Index const indices = index(from, "indices");
    if (draco) {
        order = draco->indices();
    } else if (indices == none) {
        order.resize(vertex_count);
        std::iota(order.begin(), order.end(), 0u);
    } else if (accessors.has_view(indices)) {
        order = accessors.read_integers(indices, 1);
    } else {
        throw InputError("accessor " + std::to_string(indices) + " holds vertex indices, but has no buffer view");
    }
    for (std::uint32_t const vertex : order) {
        if (vertex >= vertex_count) {
            throw InputError("vertex index " + std::to_string(vertex) + " is out of range: there are " +
                             std::to_string(vertex_count) + " vertices");
        }
    }
    return order;
}

Primitive import_primitive(GltfAccessors const& accessors, Json const& from) {
    Json const& attributes = member(from, "attributes");
    std::optional<DracoMesh> const unpacked = draco_mesh(accessors, from);
    DracoMesh const* const draco = unpacked ? &*unpacked : nullptr;
    PrimitiveReader const reader{accessors, attributes,
                                 draco ? draco->vertex_count() : accessors.count(index(attributes, "POSITION")), draco};
    Primitive primitive;
    primitive.material = index(from, "material");
    primitive.positions = reader.read<Vec3>("POSITION");
    primitive.normals = reader.read<Vec3>("NORMAL");
    primitive.tangents = reader.read<Vec4>("TANGENT");
    primitive.uv = {reader.read<Vec2>("TEXCOORD_0"), reader.read<Vec2>("TEXCOORD_1")};
    primitive.colors = reader.read_colors();
    primitive.influences = reader.read_influences();
    for (Json const& target : list(from, "targets")) {
        PrimitiveReader const offsets{accessors, target, reader.vertex_count};
        primitive.morph_targets.push_back(
            {offsets.read<Vec3>("POSITION"), offsets.read<Vec3>("NORMAL"), offsets.read<Vec3>("TANGENT")});
    }
    // What Draco has decoded is a list of triangles, whatever it was.
    primitive.triangles = make_triangles(read_order(accessors, from, draco, reader.vertex_count),
                                         draco ? triangles_mode : size(from, "mode", triangles_mode));
    return primitive;
}

} // namespace

void reserve_gltf_mesh(Json const& json, GltfAccessors const& accessors, std::size_t index_of_mesh,
                       ImportBudget& budget) {
    for (Json const& primitive : list(list(json, "meshes")[index_of_mesh], "primitives")) {
        Json const& attributes = member(primitive, "attributes");
        std::vector<std::string> said_later;
        Faults("", said_later)
            .tried(
                [&] {
                    std::size_t vertex_bytes = 0;
                    auto const add = [&](Json const& of) {
                        for (Json const& accessor : of) {
                            vertex_bytes += accessors.components(index_of(accessor)) * sizeof(float);
                        }
                    };
                    add(attributes);
                    std::ranges::for_each(list(primitive, "targets"), add);
                    std::size_t const vertices = accessors.count(index(attributes, "POSITION"));
                    Index const indices = index(primitive, "indices");
                    std::size_t const corners = indices == none ? vertices : accessors.count(indices);
                    budget.reserve(vertices, vertex_bytes);
                    budget.reserve(corners, sizeof(std::uint32_t));
                    if (member(attributes, "NORMAL").is_null()) { // flat shading gives every corner its own vertex
                        budget.reserve(corners, vertex_bytes + sizeof(Vec3));
                    }
                },
                "");
    }
}

GltfMesh import_gltf_mesh(Json const& json, GltfAccessors const& accessors, std::size_t index_of_mesh) {
    Json const& from = list(json, "meshes")[index_of_mesh];
    std::size_t const materials = list(json, "materials").size();
    GltfMesh out;
    out.mesh.name = text(from, "name");
    out.mesh.morph_weights = floats(from, "weights");
    std::string const what = named("mesh", index_of_mesh, out.mesh.name);
    Faults const faults(what, out.faults);
    if (list(from, "primitives").empty()) {
        out.faults.push_back(what + " has no primitives");
    }
    for (Json const& primitive : list(from, "primitives")) {
        faults.tried(
            [&] {
                std::uint64_t const mode = size(primitive, "mode", triangles_mode);
                if (mode > fan_mode) {
                    throw InputError("there is no mode " + std::to_string(mode) + " of primitives");
                }
                if (mode < triangles_mode) {
                    out.remarks.push_back(what + ": points and lines are not shown");
                } else if (member(member(primitive, "attributes"), "POSITION").is_null()) {
                    out.remarks.push_back(what + ": a primitive without positions is not shown");
                } else {
                    out.mesh.primitives.push_back(import_primitive(accessors, primitive));
                }
            },
            "; that part is not shown");
    }
    for (Primitive& primitive : out.mesh.primitives) {
        if (primitive.material != none && static_cast<std::size_t>(primitive.material) >= materials) {
            faults.note("material " + std::to_string(primitive.material) + " does not exist; it is shown without it");
            primitive.material = none;
        }
    }
    return out;
}

} // namespace framelet
