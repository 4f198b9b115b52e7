// Bounds what a library takes that reads files without asking. In: how much more memory this process may take.
#pragma once

#include <cstdint>

#include <sys/resource.h>

namespace framelet {

/// While it lives, allocations anywhere in the process fail (std::bad_alloc) beyond `more_bytes` above what is mapped
/// at its beginning. A lower limit of the system's stays. Does nothing where the system does not tell what is mapped.
class MemoryLimit {
public:
    explicit MemoryLimit(std::uint64_t more_bytes);
    ~MemoryLimit();
    MemoryLimit(MemoryLimit const&) = delete;
    MemoryLimit& operator=(MemoryLimit const&) = delete;

private:
    rlimit before_{};
};

} // namespace framelet
