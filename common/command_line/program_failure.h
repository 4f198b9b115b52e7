// The line that a program prints when it ends by an exception.
#pragma once

#include <exception>
#include <new>

namespace framelet {

/// Returns that line, without the program's name; it is valid as long as `error`.
inline char const* failure_text(std::exception const& error) {
    bool const memory = dynamic_cast<std::bad_alloc const*>(&error) != nullptr;
    return memory ? "there is not enough memory left: ask for a smaller picture or scene" : error.what();
}

} // namespace framelet
