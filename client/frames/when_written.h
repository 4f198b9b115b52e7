// The choice of when pictures are written.
#pragma once

#include <cstdint>

namespace framelet {

enum class WhenWritten : std::uint8_t {
    at_once,
    /// Pictures are kept until then as long as there is room for them: writing takes nothing from what is shown.
    at_the_end,
};

} // namespace framelet
