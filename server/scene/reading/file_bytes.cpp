#include "server/scene/reading/file_bytes.h"

#include <algorithm>

#include "common/error.h"

namespace framelet {

std::vector<std::byte> read_file(RegularFile const& file, std::string const& name, ImportBudget& budget,
                                 std::function<void(std::size_t)> const& on_bytes) {
    constexpr std::size_t part = 8 << 20;
    budget.reserve(file.bytes(), 1);
    std::vector<std::byte> bytes(static_cast<std::size_t>(file.bytes()));
    for (std::size_t at = 0; at < bytes.size(); at += part) {
        std::size_t const count = std::min(part, bytes.size() - at);
        if (!file.read(bytes.data() + at, count)) {
            throw InputError("file '" + name + "' cannot be read");
        }
        on_bytes(count);
    }
    return bytes;
}

} // namespace framelet
