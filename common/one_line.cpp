#include "common/one_line.h"

#include <cstdint>

namespace framelet {
namespace {

/// Number of bytes of the well-formed, printable character at the start of `text`; 0 where there is none. `text` is not
/// empty.
std::size_t character_length(std::string_view text) {
    auto const byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
    std::uint32_t const lead = byte(0);
    if (lead < 0x80) {
        return lead >= 0x20 && lead != 0x7f ? 1 : 0;
    }
    std::size_t const length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < length) {
        return 0;
    }
    std::uint32_t code = lead & (0xffu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0u) != 0x80u) {
            return 0;
        }
        code = (code << 6) | (byte(i) & 0x3fu);
    }
    std::uint32_t const smallest = length == 2 ? 0xa0u : length == 3 ? 0x800u : 0x10000u; // below A0 are controls
    bool const surrogate = code >= 0xd800 && code <= 0xdfff;
    return code < smallest || surrogate || code > 0x10ffff ? 0 : length;
}

} // namespace

bool is_one_line(std::string_view text) {
    while (!text.empty()) {
        std::size_t const length = character_length(text);
        if (length == 0) {
            return false;
        }
        text.remove_prefix(length);
    }
    return true;
}

std::string to_one_line(std::string_view text, std::size_t max_bytes) {
    std::string line;
    while (!text.empty()) {
        std::size_t const length = character_length(text);
        std::size_t const taken = length == 0 ? 1 : length;
        if (line.size() + taken > max_bytes) {
            break;
        }
        line += length == 0 ? std::string_view("?") : text.substr(0, length);
        text.remove_prefix(taken);
    }
    return line;
}

} // namespace framelet
