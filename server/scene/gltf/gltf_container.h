// Takes a binary glTF file apart. In: its bytes. Out: where its JSON and its data are, or an InputError without the
// file's name.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace framelet {

struct GltfContainer {
    std::string_view json;
    std::optional<std::span<std::byte const>> data; ///< the binary chunk; nothing where there is none
    bool is_cut = false; ///< it ends before its last chunk does, of which `data` has what is there
};

/// Chunks of other kinds are passed over (glTF 2.0 section 4.4.3.1). A file that does not begin as a binary one is JSON
/// as a whole.
GltfContainer open_gltf_container(std::span<std::byte const> bytes);

} // namespace framelet
