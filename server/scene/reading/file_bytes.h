// Reads whole files within the memory that a scene may take. In: an open file. Out: its bytes.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/files/regular_file.h"
#include "server/scene/reading/import_budget.h"

namespace framelet {

/// The bytes of an open file, which are reserved before memory is taken for them: one file may be named a thousand
/// times. `on_bytes` is called with the number of bytes that have been read since the last call. Throws InputError,
/// where they cannot be read with the `name`.
std::vector<std::byte> read_file(
    RegularFile const& file, std::string const& name, ImportBudget& budget,
    std::function<void(std::size_t)> const& on_bytes = [](std::size_t) {});

/// The same bytes as text.
inline std::string_view text_of(std::span<std::byte const> bytes) {
    return {reinterpret_cast<char const*>(bytes.data()), bytes.size()};
}

} // namespace framelet
