// The choice of what paints, as the command line says it.
#pragma once

#include <cstdint>
#include <string>

#include "common/error.h"

namespace framelet {

/// `automatic` is the graphics card where there is one.
enum class Painter : std::uint8_t { automatic, cpu, gpu };

/// Reads `auto`, `cpu` or `gpu`. Throws InputError of anything else.
inline Painter parse_painter(std::string const& text) {
    if (text == "auto") {
        return Painter::automatic;
    }
    if (text == "cpu") {
        return Painter::cpu;
    }
    if (text == "gpu") {
        return Painter::gpu;
    }
    throw InputError("a painter is auto, cpu or gpu, not " + text);
}

} // namespace framelet
