// The line on standard error by which a program tells its user something.
#pragma once

#include <iostream>
#include <string>
#include <string_view>

#include "common/one_line.h"

namespace framelet {

/// Prints "PROGRAM: TEXT", in which files and peers may be called as they like.
inline void print_line(std::string_view program, std::string_view text) {
    std::cerr << std::string(program) + ": " + to_one_line(text) + "\n" << std::flush;
}

} // namespace framelet
