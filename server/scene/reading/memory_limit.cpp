#include "server/scene/reading/memory_limit.h"

#include <algorithm>
#include <fstream>

#include <unistd.h>

namespace framelet {

MemoryLimit::MemoryLimit(std::uint64_t more_bytes) {
    ::getrlimit(RLIMIT_AS, &before_);
    std::uint64_t pages = 0;
    if (std::ifstream("/proc/self/statm") >> pages) {
        std::uint64_t const mapped = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
        rlimit limit = before_;
        limit.rlim_cur = std::min<std::uint64_t>(limit.rlim_cur, mapped + more_bytes);
        ::setrlimit(RLIMIT_AS, &limit);
    }
}

MemoryLimit::~MemoryLimit() {
    ::setrlimit(RLIMIT_AS, &before_);
}

} // namespace framelet
