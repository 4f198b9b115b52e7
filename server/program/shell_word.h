// Writes a text as one word of a command line. In: any bytes. Out: what to type in bash, on one line.
#pragma once

#include <string>

namespace framelet {

/// The text itself where the shell takes it as it stands, else in quotes; a terminal obeys nothing of it.
std::string shell_word(std::string const& text);

} // namespace framelet
