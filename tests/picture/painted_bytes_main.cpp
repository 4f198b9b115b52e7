// Writes what the painters make, as they are compiled into this program, to standard output.
#include <cstdio>

#include "tests/picture/painted_bytes.h"

int main() {
    std::vector<std::uint8_t> const bytes = framelet::painted_bytes();
    return std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() ? 0 : 1;
}
