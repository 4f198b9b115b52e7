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

/// The reason why nothing can be said here of the C library's memory, or nullptr.
char const* other_memory() {
#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__)
    return "memory is another library's here";
#endif
#ifdef __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
    return "memory is the sanitizer's";
#endif
#endif
    return nullptr;
}

/// Takes 64 MB in blocks, small ones between them, and frees the large ones; the small ones stay.
void take_and_free(std::size_t large_bytes, std::vector<std::unique_ptr<Block>>& small) {
    std::vector<Block> large;
    for (std::size_t taken = 0; taken < 64 << 20; taken += large_bytes) {
        large.emplace_back(large_bytes, 'x');
        small.push_back(std::make_unique<Block>(2000, 'x'));
    }
}

/// By the second round glibc would have learnt from the first that such blocks are better kept.
TEST(LargeBlocks, GoBackToTheSystem) {
    if (char const* const reason = other_memory()) {
        GTEST_SKIP() << reason;
    }
    give_back_large_blocks();
    std::size_t const before = resident_bytes();
    std::vector<std::unique_ptr<Block>> small;
    take_and_free(320 << 10, small);
    take_and_free(320 << 10, small);
    EXPECT_LT(resident_bytes(), before + (16 << 20));
}

TEST(SmallBlocks, GoBackToTheSystemWhenAsked) {
    if (char const* const reason = other_memory()) {
        GTEST_SKIP() << reason;
    }
    give_back_small_blocks(); // of whatever ran before in this process, which else would be taken again
    std::size_t const before = resident_bytes();
    std::vector<std::unique_ptr<Block>> small;
    take_and_free(32 << 10, small);
    EXPECT_GT(resident_bytes(), before + (48 << 20)) << "else there is nothing to give back";
    give_back_small_blocks();
    EXPECT_LT(resident_bytes(), before + (20 << 20));
}

} // namespace
} // namespace framelet
