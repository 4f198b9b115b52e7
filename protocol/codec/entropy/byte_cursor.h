// Bytes that are read from their front, never beyond their end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/error.h"

namespace framelet {

struct ByteCursor {
    std::uint8_t const* next = nullptr;
    std::uint8_t const* end = nullptr;

    std::size_t left() const { return static_cast<std::size_t>(end - next); }

    /// Takes the next `size` bytes. ProtocolError where there are fewer.
    std::span<std::uint8_t const> take(std::size_t size) {
        if (size > left()) {
            throw ProtocolError("a group of a batch is shorter than its parts");
        }
        std::span<std::uint8_t const> const part{next, size};
        next += size;
        return part;
    }
};

} // namespace framelet
