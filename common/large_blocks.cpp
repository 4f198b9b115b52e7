#include "common/large_blocks.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace framelet {

void give_back_large_blocks() {
#ifdef __GLIBC__
    constexpr int most_free_bytes = 16 << 20;
    mallopt(M_MMAP_THRESHOLD, static_cast<int>(least_large_block));
    mallopt(M_TRIM_THRESHOLD, most_free_bytes); // less would be given back and asked for again all the time
#endif
}

void give_back_small_blocks() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

} // namespace framelet
