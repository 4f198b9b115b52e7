#include "server/scene/gltf/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include <tiny_gltf.h>

#include "common/error.h"

namespace framelet {
namespace {

struct Layout {
    std::size_t components = 0;
    std::size_t component_size = 0;
    std::size_t stride = 0;
    std::size_t element_size() const { return components * component_size; }
};

[[noreturn]] void fail(std::string const& what, std::string const& why) {
    throw InputError(what + " " + why);
}

std::string accessor_name(int index) {
    return "accessor " + std::to_string(index);
}

/// The first of `count` elements of a buffer view from byte `offset` on; all of them are checked to lie inside.
std::byte const* elements_of(std::span<std::byte const> view, std::uint64_t offset, std::uint64_t count,
                             Layout const& layout, std::string const& what) {
    std::uint64_t const size = view.size();
    std::uint64_t const element = layout.element_size();
    bool const fits = count == 0 || (layout.stride >= element && offset <= size && element <= size - offset &&
                                     count - 1 <= (size - offset - element) / layout.stride);
    if (!fits) {
        fail(what, "reaches beyond its buffer view: " + std::to_string(count) + " elements from byte " +
                       std::to_string(offset) + " of " + std::to_string(size));
    }
    return view.data() + (count == 0 ? 0 : offset);
}

template <class T>
T load(std::byte const* from) {
    T value;
    std::memcpy(&value, from, sizeof(T));
    return value;
}

template <class T>
void convert(std::byte const* from, std::size_t components, bool normalized, float* out) {
    constexpr auto largest = static_cast<float>(std::numeric_limits<T>::max());
    for (std::size_t c = 0; c < components; ++c) {
        auto const value = static_cast<float>(load<T>(from + c * sizeof(T)));
        out[c] = normalized ? std::max(value / largest, -1.0f) : value;
    }
}

/// Converts one element to floats (glTF 2.0 section 3.6.2.2: c / max, not below -1, where normalised).
void convert_element(int type, bool normalized, std::byte const* from, std::size_t components, float* out) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return convert<std::int8_t>(from, components, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return convert<std::uint8_t>(from, components, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return convert<std::int16_t>(from, components, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return convert<std::uint16_t>(from, components, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return convert<std::uint32_t>(from, components, false, out);
    default:
        std::memcpy(out, from, components * sizeof(float));
    }
}

std::uint32_t load_unsigned(int type, std::byte const* from) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return load<std::uint8_t>(from);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return load<std::uint16_t>(from);
    default:
        return load<std::uint32_t>(from);
    }
}

bool is_unsigned(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

std::size_t component_size(int type, std::string const& what) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
    default:
        fail(what, "has the unknown component type " + std::to_string(type));
    }
}

/// Calls `visit(index, bytes)` for every element, those that a sparse accessor replaces last.
template <class Visit>
void for_each_element(GltfAccessors const& accessors, tinygltf::Model const& model, tinygltf::Accessor const& accessor,
                      std::string const& what, Visit const& visit) {
    Layout layout{static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type))),
                  component_size(accessor.componentType, what), 0};
    if (accessor.bufferView >= 0) {
        std::span<std::byte const> const view = accessors.view(accessor.bufferView);
        std::size_t const stride = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
        layout.stride = stride ? stride : layout.element_size();
        std::byte const* const first = elements_of(view, accessor.byteOffset, accessor.count, layout, what);
        for (std::size_t i = 0; i < accessor.count; ++i) {
            visit(i, first + i * layout.stride);
        }
    }
    if (accessor.sparse.isSparse && accessor.sparse.count > 0) {
        auto const& sparse = accessor.sparse;
        auto const count = static_cast<std::size_t>(sparse.count);
        if (!is_unsigned(sparse.indices.componentType)) {
            fail(what, "has sparse indices of the wrong type");
        }
        std::size_t const index_size = component_size(sparse.indices.componentType, what);
        // Negative offsets become huge and are refused like any other that is too large.
        std::byte const* const indices = elements_of(accessors.view(sparse.indices.bufferView),
                                                     static_cast<std::uint64_t>(sparse.indices.byteOffset), count,
                                                     {1, index_size, index_size}, what + " (sparse indices)");
        layout.stride = layout.element_size();
        std::byte const* const values =
            elements_of(accessors.view(sparse.values.bufferView), static_cast<std::uint64_t>(sparse.values.byteOffset),
                        count, layout, what + " (sparse values)");
        for (std::size_t i = 0; i < count; ++i) {
            std::uint32_t const index = load_unsigned(sparse.indices.componentType, indices + i * index_size);
            if (index >= accessor.count) {
                fail(what, "has the sparse index " + std::to_string(index) + ", but only " +
                               std::to_string(accessor.count) + " elements");
            }
            visit(index, values + i * layout.stride);
        }
    }
}

} // namespace

std::span<std::byte const> GltfAccessors::view(int buffer_view) const {
    std::string const what = "buffer view " + std::to_string(buffer_view);
    if (buffer_view < 0 || static_cast<std::size_t>(buffer_view) >= model_.bufferViews.size()) {
        fail(what, "is used but does not exist");
    }
    tinygltf::BufferView const& view = model_.bufferViews[static_cast<std::size_t>(buffer_view)];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_.buffers.size()) {
        fail(what, "is of buffer " + std::to_string(view.buffer) + ", which does not exist");
    }
    auto const& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
        fail(what, "reaches beyond its buffer: " + std::to_string(view.byteLength) + " bytes from byte " +
                       std::to_string(view.byteOffset) + " of " + std::to_string(data.size()));
    }
    return std::as_bytes(std::span(data)).subspan(view.byteOffset, view.byteLength);
}

tinygltf::Accessor const& GltfAccessors::find(int accessor) const {
    if (accessor < 0 || static_cast<std::size_t>(accessor) >= model_.accessors.size()) {
        fail(accessor_name(accessor), "is used but does not exist");
    }
    return model_.accessors[static_cast<std::size_t>(accessor)];
}

std::size_t GltfAccessors::count(int accessor) const {
    tinygltf::Accessor const& found = find(accessor);
    if (found.bufferView >= 0 && found.count > view(found.bufferView).size()) {
        fail(accessor_name(accessor), "reaches beyond its buffer view: " + std::to_string(found.count) + " elements");
    }
    if (found.bufferView < 0 && found.count > max_zero_elements) {
        fail(accessor_name(accessor), "has " + std::to_string(found.count) + " elements but no buffer view");
    }
    return found.count;
}

int GltfAccessors::components(int accessor) const {
    return tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(find(accessor).type));
}

/// Number of elements, once memory for that many may be allocated.
std::size_t GltfAccessors::checked_count(int accessor, std::size_t components_wanted, std::size_t bytes_each) const {
    if (static_cast<std::size_t>(components(accessor)) != components_wanted) {
        fail(accessor_name(accessor), "has " + std::to_string(components(accessor)) + " components where " +
                                          std::to_string(components_wanted) + " are needed");
    }
    std::size_t const elements = count(accessor);
    budget_.reserve(elements, bytes_each);
    return elements;
}

void GltfAccessors::read_floats(int accessor, float* out) const {
    tinygltf::Accessor const& found = find(accessor);
    auto const n = static_cast<std::size_t>(components(accessor));
    if (n > 4 && found.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
        fail(accessor_name(accessor), "is a matrix of integers");
    }
    for_each_element(*this, model_, found, accessor_name(accessor), [&](std::size_t i, std::byte const* from) {
        convert_element(found.componentType, found.normalized, from, n, out + i * n);
    });
}

std::vector<std::uint32_t> GltfAccessors::read_integers(int accessor, int components_wanted) const {
    tinygltf::Accessor const& found = find(accessor);
    auto const n = static_cast<std::size_t>(components_wanted);
    if (!is_unsigned(found.componentType)) {
        fail(accessor_name(accessor), "must hold unsigned integers");
    }
    std::size_t const size = component_size(found.componentType, accessor_name(accessor));
    std::vector<std::uint32_t> values(checked_count(accessor, n, n * sizeof(std::uint32_t)) * n);
    for_each_element(*this, model_, found, accessor_name(accessor), [&](std::size_t i, std::byte const* from) {
        for (std::size_t c = 0; c < n; ++c) {
            values[i * n + c] = load_unsigned(found.componentType, from + c * size);
        }
    });
    return values;
}

} // namespace framelet
