// When pictures are written.
#pragma once

#include <cstdint>

namespace framelet {

enum class WhenWritten : std::uint8_t {
    at_once,
    /// As long as there is room for them: writing takes nothing from what is shown.
    at_the_end,
};

} // namespace framelet
