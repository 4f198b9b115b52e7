#include "client/picture_size.h"

#include <charconv>

#include "common/error.h"

namespace framelet {

Viewport parse_size(std::string const& text) {
    Viewport out;
    char const* const end = text.data() + text.size();
    auto const width = std::from_chars(text.data(), end, out.width);
    bool good = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
    if (good) {
        auto const height = std::from_chars(width.ptr + 1, end, out.height);
        good = height.ec == std::errc() && height.ptr == end;
    }
    auto const usable = [](int side) { return side >= 1 && side <= max_viewport_side; };
    if (!good || !usable(out.width) || !usable(out.height)) {
        throw InputError("cannot use \"" + text + "\" as a picture size: write WIDTHxHEIGHT, each 1 to " +
                         std::to_string(max_viewport_side) + ", as in 1280x720");
    }
    return out;
}

} // namespace framelet
