// What every program has open from its start. Where 0, 1 or 2 is not, a file or a connection would get that number, and
// with it what is printed.
#pragma once

#include <fcntl.h>
#include <unistd.h>

namespace framelet {

/// Opens those of the three that are closed, on nothing. To be called before anything else is opened.
inline void open_standard_files() {
    for (int number = STDIN_FILENO; number <= STDERR_FILENO; ++number) {
        if (::fcntl(number, F_GETFD) < 0) {
            ::open("/dev/null", O_RDWR | O_NOCTTY); // the lowest number that is free
        }
    }
}

} // namespace framelet
