// What a program is asked for on standard output.
#pragma once

#include <cerrno>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace framelet {

struct OutputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Prints the text. Throws OutputError where it cannot be printed as a whole, as on a full disk.
inline void print_output(std::string_view text) {
    errno = 0;
    if (!(std::cout << text << std::flush)) {
        throw OutputError(std::string("cannot write to standard output: ") + std::strerror(errno));
    }
}

} // namespace framelet
