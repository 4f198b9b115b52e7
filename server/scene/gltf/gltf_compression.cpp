#include "server/scene/gltf/gltf_compression.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <draco/compression/decode.h>
#include <meshoptimizer.h>

#include "common/error.h"
#include "server/scene/reading/faults.h"

namespace framelet {
namespace {

constexpr char const* meshopt_names[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

/// What a buffer view says of its compressed bytes.
struct Packed {
    std::span<std::byte const> bytes;
    std::uint64_t count, stride; ///< of what comes of them
    std::string mode, filter;
};

Packed find_packed(GltfFile const& file, Json const& from) {
    std::size_t const buffer = checked(member(from, "buffer"), file.buffers.size(), "buffer");
    std::span<std::byte const> const data = file.buffers[buffer];
    std::uint64_t const offset = size(from, "byteOffset", 0);
    std::uint64_t const length = size(from, "byteLength", 0);
    if (offset > data.size() || length > data.size() - offset) {
        throw InputError("its compressed bytes reach beyond their buffer");
    }
    return {data.subspan(offset, length), size(from, "count", 0), size(from, "byteStride", 0), text(from, "mode"),
            text(from, "filter")};
}

/// Throws InputError for numbers that the library takes for granted.
void check_layout(Packed const& packed) {
    std::uint64_t const stride = packed.stride;
    bool const is_index = stride == 2 || stride == 4;
    bool const fits = packed.mode == "ATTRIBUTES"  ? stride % 4 == 0 && stride >= 4 && stride <= 256
                      : packed.mode == "TRIANGLES" ? is_index && packed.count % 3 == 0
                                                   : packed.mode == "INDICES" && is_index;
    bool const filter_fits = packed.filter.empty() || packed.filter == "NONE" ||
                             (packed.mode == "ATTRIBUTES" &&
                              ((packed.filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) ||
                               (packed.filter == "QUATERNION" && stride == 8) || packed.filter == "EXPONENTIAL"));
    if (!fits || !filter_fits) {
        throw InputError("it cannot be decoded: mode '" + packed.mode + "', filter '" + packed.filter + "', " +
                         std::to_string(packed.count) + " elements of " + std::to_string(stride) + " bytes");
    }
}

std::vector<std::byte> unpack(Packed const& packed, ImportBudget& budget) {
    check_layout(packed);
    budget.reserve(packed.count, packed.stride);
    auto const count = static_cast<std::size_t>(packed.count);
    auto const stride = static_cast<std::size_t>(packed.stride);
    std::vector<std::byte> out(count * stride);
    auto const* const from = reinterpret_cast<unsigned char const*>(packed.bytes.data());
    int (*decode)(void*, std::size_t, std::size_t, unsigned char const*, std::size_t) = meshopt_decodeIndexSequence;
    if (packed.mode == "ATTRIBUTES") {
        decode = meshopt_decodeVertexBuffer;
    } else if (packed.mode == "TRIANGLES") {
        decode = meshopt_decodeIndexBuffer;
    }
    if (count > 0 && decode(out.data(), count, stride, from, packed.bytes.size()) != 0) {
        throw InputError("its compressed bytes are broken");
    }
    if (packed.filter == "OCTAHEDRAL") {
        meshopt_decodeFilterOct(out.data(), count, stride);
    } else if (packed.filter == "QUATERNION") {
        meshopt_decodeFilterQuat(out.data(), count, stride);
    } else if (packed.filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(out.data(), count, stride);
    }
    return out;
}

/// The largest value of integers of that type; 1 for floats.
float largest(draco::DataType type) {
    switch (type) {
    case draco::DT_INT8:
        return std::numeric_limits<std::int8_t>::max();
    case draco::DT_UINT8:
        return std::numeric_limits<std::uint8_t>::max();
    case draco::DT_INT16:
        return std::numeric_limits<std::int16_t>::max();
    case draco::DT_UINT16:
        return std::numeric_limits<std::uint16_t>::max();
    default:
        return 1;
    }
}

} // namespace

void decompress_views(GltfFile& file, ImportBudget& budget, std::vector<std::string>& faults) {
    Json::array_t const& views = list(file.json, "bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i) {
        for (char const* const name : meshopt_names) {
            if (Json const& packed = extension(views[i], name); !packed.is_null()) {
                Faults(named("buffer view", i, ""), faults)
                    .tried(
                        [&] {
                            file.decoded_views[static_cast<Index>(i)] =
                                file.memory.emplace_back(unpack(find_packed(file, packed), budget));
                        },
                        "");
            }
        }
    }
}

struct DracoMesh::Parts {
    Parts() noexcept(false) = default; // memory for the JSON may be missing

    std::unique_ptr<draco::Mesh> mesh;
    Json ids;

    draco::PointAttribute const* find(std::string const& name) const {
        Index const id = index(ids, name.c_str());
        return id < 0 ? nullptr : mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    }
    /// The attribute, which must have so many components.
    draco::PointAttribute const& get(std::string const& name, std::size_t components) const {
        draco::PointAttribute const* const found = find(name);
        if (!found || static_cast<std::size_t>(found->num_components()) != components) {
            throw InputError("its Draco data has no attribute " + name + " of " + std::to_string(components) +
                             " components");
        }
        return *found;
    }
    template <typename T, typename Visit>
    void for_each_vertex(draco::PointAttribute const& attribute, Visit const& visit) const {
        auto const components = static_cast<std::size_t>(attribute.num_components());
        std::vector<T> element(components);
        for (std::uint32_t vertex = 0; vertex < mesh->num_points(); ++vertex) {
            draco::AttributeValueIndex const value = attribute.mapped_index(draco::PointIndex(vertex));
            if (value.value() >= attribute.size() ||
                !attribute.ConvertValue<T>(value, static_cast<std::int8_t>(components), element.data())) {
                throw InputError("its Draco data is broken");
            }
            visit(vertex, element);
        }
    }
};

DracoMesh::DracoMesh(std::span<std::byte const> bytes, Json const& ids) : parts_(std::make_unique<Parts>()) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<char const*>(bytes.data()), bytes.size());
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) {
        throw InputError(std::string("its Draco data cannot be decoded: ") + decoded.status().error_msg());
    }
    parts_->mesh = std::move(decoded).value();
    parts_->ids = ids;
}

DracoMesh::~DracoMesh() = default;
DracoMesh::DracoMesh(DracoMesh&&) noexcept = default;

std::size_t DracoMesh::vertex_count() const {
    return parts_->mesh->num_points();
}

bool DracoMesh::has(std::string const& name) const {
    return !member(parts_->ids, name.c_str()).is_null();
}

std::size_t DracoMesh::components(std::string const& name) const {
    draco::PointAttribute const* const found = parts_->find(name);
    return found ? static_cast<std::size_t>(found->num_components()) : 0;
}

void DracoMesh::read(std::string const& name, bool normalized, std::size_t components, float* out) const {
    draco::PointAttribute const& attribute = parts_->get(name, components);
    // Of its own `normalized` the decoder takes care; few encoders set it.
    float const divisor = normalized && !attribute.normalized() ? largest(attribute.data_type()) : 1;
    parts_->for_each_vertex<float>(attribute, [&](std::size_t vertex, std::vector<float> const& element) {
        for (std::size_t c = 0; c < components; ++c) {
            out[vertex * components + c] = divisor == 1 ? element[c] : std::max(element[c] / divisor, -1.0f);
        }
    });
}

std::vector<std::uint32_t> DracoMesh::read_integers(std::string const& name, std::size_t components) const {
    std::vector<std::uint32_t> out(vertex_count() * components);
    parts_->for_each_vertex<std::uint32_t>(
        parts_->get(name, components), [&](std::size_t vertex, std::vector<std::uint32_t> const& element) {
            std::ranges::copy(element, out.begin() + static_cast<std::ptrdiff_t>(vertex * components));
        });
    return out;
}

std::vector<std::uint32_t> DracoMesh::indices() const {
    std::vector<std::uint32_t> out;
    out.reserve(std::size_t(3) * parts_->mesh->num_faces());
    for (draco::FaceIndex face(0); face < parts_->mesh->num_faces(); ++face) {
        for (draco::PointIndex const& point : parts_->mesh->face(face)) {
            out.push_back(point.value());
        }
    }
    return out;
}

} // namespace framelet
