#include <fstream>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/large_blocks.h"

namespace framelet {
namespace {

using Block = std::vector<char>;

std::size_t resident_bytes() {
    std::ifstream counts("/proc/self/statm");
    std::size_t all = 0, resident = 0;
    counts >> all >> resident;
    return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// Takes 64 MB in blocks, small ones between them, and frees the large ones; the small ones stay.
void take_and_free(std::vector<std::unique_ptr<Block>>& small) {
    std::vector<Block> large;
    for (int i = 0; i < 200; ++i) {
        large.emplace_back(320 << 10, 'x');
        small.push_back(std::make_unique<Block>(2000, 'x'));
    }
}

/// By the second round glibc would have learnt from the first that such blocks are better kept.
TEST(LargeBlocks, GoBackToTheSystem) {
#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__)
    GTEST_SKIP() << "memory is another library's here";
#endif
#ifdef __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
    GTEST_SKIP() << "memory is the sanitizer's";
#endif
#endif
    give_back_large_blocks();
    std::size_t const before = resident_bytes();
    std::vector<std::unique_ptr<Block>> small;
    take_and_free(small);
    take_and_free(small);
    EXPECT_LT(resident_bytes(), before + (16 << 20));
}

} // namespace
} // namespace framelet
