#include "server/scene/gltf/gltf_accessor.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "common/error.h"

namespace framelet {
namespace {

/// Component types, by the numbers of the specification (glTF 2.0 section 3.6.2.2).
enum ComponentType : std::uint64_t { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

struct Layout {
    std::size_t components = 0;
    std::size_t component_size = 0;
    std::size_t stride = 0;
    std::size_t element_size() const { return components * component_size; }
};

[[noreturn]] void fail(std::string const& what, std::string const& why) {
    throw InputError(what + " " + why);
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
void convert_element(std::uint64_t type, bool normalized, std::byte const* from, std::size_t components, float* out) {
    switch (type) {
    case i8:
        return convert<std::int8_t>(from, components, normalized, out);
    case u8:
        return convert<std::uint8_t>(from, components, normalized, out);
    case i16:
        return convert<std::int16_t>(from, components, normalized, out);
    case u16:
        return convert<std::uint16_t>(from, components, normalized, out);
    case u32:
        return convert<std::uint32_t>(from, components, false, out);
    default:
        std::memcpy(out, from, components * sizeof(float));
    }
}

std::uint32_t load_unsigned(std::uint64_t type, std::byte const* from) {
    switch (type) {
    case u8:
        return load<std::uint8_t>(from);
    case u16:
        return load<std::uint16_t>(from);
    default:
        return load<std::uint32_t>(from);
    }
}

bool is_unsigned(std::uint64_t type) {
    return type == u8 || type == u16 || type == u32;
}

std::size_t component_size(std::uint64_t type, std::string const& what) {
    switch (type) {
    case i8:
    case u8:
        return 1;
    case i16:
    case u16:
        return 2;
    case u32:
    case f32:
        return 4;
    default:
        fail(what, "has the unknown component type " + std::to_string(type));
    }
}

/// Components of an element; 0 where the type is none.
std::size_t components_of(std::string_view type) {
    constexpr std::array<std::pair<std::string_view, std::size_t>, 7> known{
        {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
    auto const* const found = std::ranges::find(known, type, &std::pair<std::string_view, std::size_t>::first);
    return found == known.end() ? 0 : found->second;
}

} // namespace

struct GltfAccessors::Accessor {
    std::string what; ///< for messages
    std::uint64_t component_type;
    std::size_t components;
    bool normalized;
    std::uint64_t count;
    Index view; ///< `none`: all elements are zero, but for those that `sparse` replaces
    std::uint64_t offset; ///< bytes
    Json const& sparse; ///< null where it is not
};

std::span<std::byte const> GltfAccessors::view(Index buffer_view) const {
    Json::array_t const& views = list(file_.json, "bufferViews");
    std::string const what = "buffer view " + std::to_string(buffer_view);
    if (buffer_view < 0 || static_cast<std::size_t>(buffer_view) >= views.size()) {
        fail(what, "is used but does not exist");
    }
    if (auto const decoded = file_.decoded_views.find(buffer_view); decoded != file_.decoded_views.end()) {
        return decoded->second;
    }
    Json const& view = views[static_cast<std::size_t>(buffer_view)];
    Index const buffer = index(view, "buffer");
    if (buffer < 0 || static_cast<std::size_t>(buffer) >= file_.buffers.size()) {
        fail(what, "is of buffer " + std::to_string(buffer) + ", which does not exist");
    }
    std::span<std::byte const> const data = file_.buffers[static_cast<std::size_t>(buffer)];
    std::uint64_t const offset = size(view, "byteOffset", 0);
    std::uint64_t const length = size(view, "byteLength", 0);
    if (offset > data.size() || length > data.size() - offset) {
        fail(what, "reaches beyond its buffer: " + std::to_string(length) + " bytes from byte " +
                       std::to_string(offset) + " of " + std::to_string(data.size()));
    }
    return data.subspan(offset, length);
}

GltfAccessors::Accessor GltfAccessors::find(Index accessor) const {
    Json::array_t const& accessors = list(file_.json, "accessors");
    std::string what = "accessor " + std::to_string(accessor);
    if (accessor < 0 || static_cast<std::size_t>(accessor) >= accessors.size()) {
        fail(what, "is used but does not exist");
    }
    Json const& from = accessors[static_cast<std::size_t>(accessor)];
    try {
        return {std::move(what),
                size(from, "componentType", 0),
                components_of(text(from, "type")),
                flag(from, "normalized", false),
                size(from, "count", 0),
                index(from, "bufferView"),
                size(from, "byteOffset", 0),
                member(from, "sparse")};
    } catch (InputError const& error) {
        fail("accessor " + std::to_string(accessor) + ":", error.what());
    }
}

/// Calls `visit(index, bytes)` for every element, those that a sparse accessor replaces last.
template <class Visit>
void GltfAccessors::for_each_element(Accessor const& accessor, Visit const& visit) const {
    Layout layout{accessor.components, component_size(accessor.component_type, accessor.what), 0};
    if (accessor.view != none) {
        std::span<std::byte const> const bytes = view(accessor.view);
        std::uint64_t const stride =
            size(list(file_.json, "bufferViews")[static_cast<std::size_t>(accessor.view)], "byteStride", 0);
        layout.stride = stride ? stride : layout.element_size();
        std::byte const* const first = elements_of(bytes, accessor.offset, accessor.count, layout, accessor.what);
        for (std::size_t i = 0; i < accessor.count; ++i) {
            visit(i, first + i * layout.stride);
        }
    }
    std::uint64_t const count = size(accessor.sparse, "count", 0);
    if (count == 0) {
        return;
    }
    Json const& indices = member(accessor.sparse, "indices");
    Json const& values = member(accessor.sparse, "values");
    for (auto const& [part, name] : {std::pair(&indices, "indices"), std::pair(&values, "values")}) {
        if (index(*part, "bufferView") == none) {
            fail(accessor.what, std::string("is sparse, but its ") + name + " have no buffer view");
        }
    }
    std::uint64_t const type = size(indices, "componentType", 0);
    if (!is_unsigned(type)) {
        fail(accessor.what, "has sparse indices of the wrong type");
    }
    std::size_t const index_size = component_size(type, accessor.what);
    std::byte const* const places =
        elements_of(view(index(indices, "bufferView")), size(indices, "byteOffset", 0), count,
                    {1, index_size, index_size}, accessor.what + " (sparse indices)");
    layout.stride = layout.element_size();
    std::byte const* const replacing = elements_of(view(index(values, "bufferView")), size(values, "byteOffset", 0),
                                                   count, layout, accessor.what + " (sparse values)");
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t const place = load_unsigned(type, places + i * index_size);
        if (place >= accessor.count) {
            fail(accessor.what, "has the sparse index " + std::to_string(place) + ", but only " +
                                    std::to_string(accessor.count) + " elements");
        }
        visit(place, replacing + i * layout.stride);
    }
}

std::size_t GltfAccessors::count(Index accessor) const {
    Accessor const found = find(accessor);
    if (found.view != none && found.count > view(found.view).size()) {
        fail(found.what, "reaches beyond its buffer view: " + std::to_string(found.count) + " elements");
    }
    if (found.view == none && found.count > max_zero_elements) {
        fail(found.what, "has " + std::to_string(found.count) + " elements but no buffer view");
    }
    return static_cast<std::size_t>(found.count);
}

bool GltfAccessors::has_view(Index accessor) const {
    return find(accessor).view != none;
}

bool GltfAccessors::is_normalized(Index accessor) const {
    return find(accessor).normalized;
}

std::size_t GltfAccessors::components(Index accessor) const {
    return find(accessor).components;
}

/// Number of elements, once memory for that many may be allocated.
std::size_t GltfAccessors::checked_count(Index accessor, std::size_t components_wanted, std::size_t bytes_each) const {
    if (std::size_t const has = components(accessor); has != components_wanted) {
        fail("accessor " + std::to_string(accessor),
             "has " + std::to_string(has) + " components where " + std::to_string(components_wanted) + " are needed");
    }
    std::size_t const elements = count(accessor);
    budget_.reserve(elements, bytes_each);
    return elements;
}

void GltfAccessors::read_floats(Index accessor, float* out) const {
    Accessor const found = find(accessor);
    std::size_t const n = found.components;
    if (n > 4 && found.component_type != f32) {
        fail(found.what, "is a matrix of integers");
    }
    for_each_element(found, [&](std::size_t i, std::byte const* from) {
        convert_element(found.component_type, found.normalized, from, n, out + i * n);
    });
}

std::vector<std::uint32_t> GltfAccessors::read_integers(Index accessor, std::size_t n) const {
    Accessor const found = find(accessor);
    if (!is_unsigned(found.component_type)) {
        fail(found.what, "must hold unsigned integers");
    }
    std::size_t const each = component_size(found.component_type, found.what);
    std::vector<std::uint32_t> values(checked_count(accessor, n, n * sizeof(std::uint32_t)) * n);
    for_each_element(found, [&](std::size_t i, std::byte const* from) {
        for (std::size_t c = 0; c < n; ++c) {
            values[i * n + c] = load_unsigned(found.component_type, from + c * each);
        }
    });
    return values;
}

} // namespace framelet
