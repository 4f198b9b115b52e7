#include "server/scene/gltf/gltf_container.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "common/error.h"

namespace framelet {
namespace {

constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8;
constexpr std::uint32_t magic = 0x46546C67, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

std::uint32_t word(std::span<std::byte const> bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

std::string_view as_text(std::span<std::byte const> bytes) {
    std::string_view const text(reinterpret_cast<char const*>(bytes.data()), bytes.size());
    return text.substr(0, text.find_last_not_of('\0') + 1); // some fill it up with zeros
}

} // namespace

GltfContainer open_gltf_container(std::span<std::byte const> bytes) {
    GltfContainer out;
    if (bytes.size() < sizeof magic || word(bytes, 0) != magic) {
        out.json = as_text(bytes);
        return out;
    }
    constexpr std::size_t first_end = header_bytes + chunk_header_bytes;
    if (bytes.size() < first_end) {
        throw InputError("the file is truncated: its header is incomplete");
    }
    if (std::uint32_t const version = word(bytes, 4); version != 2) {
        throw InputError("it is binary glTF version " + std::to_string(version) + "; only 2 is supported");
    }
    std::size_t const promised = word(bytes, 8);
    std::size_t const end = promised < first_end ? bytes.size() : std::min(promised, bytes.size());
    bool has_json = false;
    for (std::size_t at = header_bytes; at + chunk_header_bytes <= end;) {
        std::size_t const length = word(bytes, at);
        std::uint32_t const kind = word(bytes, at + 4);
        std::span<std::byte const> const rest = bytes.subspan(at + chunk_header_bytes);
        std::span<std::byte const> const chunk = rest.first(std::min(length, rest.size()));
        out.is_cut = chunk.size() < length;
        if (kind == json_chunk && !has_json) {
            if (out.is_cut) {
                throw InputError("the file is truncated: it has " + std::to_string(bytes.size()) + " of " +
                                 std::to_string(std::max(promised, at + chunk_header_bytes + length)) + " bytes");
            }
            out.json = as_text(chunk);
            has_json = true;
        } else if (kind == binary_chunk && !out.data) {
            out.data = chunk;
        }
        at += chunk_header_bytes + chunk.size();
    }
    if (!has_json) {
        throw InputError("it has no JSON");
    }
    out.is_cut = out.is_cut || promised > bytes.size();
    return out;
}

} // namespace framelet
