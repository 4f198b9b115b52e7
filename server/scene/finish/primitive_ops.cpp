#include "server/scene/finish/primitive_ops.h"

namespace framelet {
namespace {

template <class T>
std::vector<T> gather(std::vector<T> const& values, std::span<std::uint32_t const> source) {
    std::vector<T> result;
    if (!values.empty()) {
        result.reserve(source.size());
        for (std::uint32_t const index : source) {
            result.push_back(values[index]);
        }
    }
    return result;
}

} // namespace

Primitive gather_vertices(Primitive const& primitive, std::span<std::uint32_t const> source) {
    Primitive result;
    result.material = primitive.material;
    result.positions = gather(primitive.positions, source);
    result.normals = gather(primitive.normals, source);
    result.tangents = gather(primitive.tangents, source);
    result.uv = {gather(primitive.uv[0], source), gather(primitive.uv[1], source)};
    result.colors = gather(primitive.colors, source);
    result.influences = gather(primitive.influences, source);
    for (MorphTarget const& target : primitive.morph_targets) {
        result.morph_targets.push_back(
            {gather(target.positions, source), gather(target.normals, source), gather(target.tangents, source)});
    }
    return result;
}

std::size_t bytes_per_vertex(Primitive const& primitive) {
    auto const bytes = [](auto const& values) { return values.empty() ? 0 : sizeof(values[0]); };
    std::size_t sum = bytes(primitive.positions) + bytes(primitive.normals) + bytes(primitive.tangents) +
                      bytes(primitive.uv[0]) + bytes(primitive.uv[1]) + bytes(primitive.colors) +
                      bytes(primitive.influences);
    for (MorphTarget const& target : primitive.morph_targets) {
        sum += bytes(target.positions) + bytes(target.normals) + bytes(target.tangents);
    }
    return sum;
}

void drop_unused_vertices(Primitive& primitive) {
    constexpr std::uint32_t unused = ~0u;
    std::vector<std::uint32_t> new_index(primitive.positions.size(), unused);
    for (auto const& triangle : primitive.triangles) {
        for (std::uint32_t const vertex : triangle) {
            new_index[vertex] = 0;
        }
    }
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < new_index.size(); ++i) {
        if (new_index[i] != unused) {
            new_index[i] = static_cast<std::uint32_t>(kept.size());
            kept.push_back(static_cast<std::uint32_t>(i));
        }
    }
    if (kept.size() == primitive.positions.size()) {
        return;
    }
    Primitive result = gather_vertices(primitive, kept);
    result.triangles = std::move(primitive.triangles);
    for (auto& triangle : result.triangles) {
        for (std::uint32_t& vertex : triangle) {
            vertex = new_index[vertex];
        }
    }
    primitive = std::move(result);
}

} // namespace framelet
