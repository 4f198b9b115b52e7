#include "common/per_thread.h"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#ifdef FRAMELET_SANITIZE_ADDRESS
#include <sanitizer/lsan_interface.h>
#endif

namespace framelet {
namespace {

TEST(PerThread, ThreadsDoNotShareAndKeepWhatTheyHave) {
    PerThread<std::vector<std::size_t>> lists;
    constexpr std::size_t count = 100000;
    lists.prepare();
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { lists.local().push_back(i); });
    std::vector<bool> found(count);
    lists.for_each([&](std::vector<std::size_t> const& list) {
        for (std::size_t const i : list) {
            EXPECT_FALSE(found[i]);
            found[i] = true;
        }
    });
    EXPECT_EQ(std::vector<bool>(count, true), found);
}

#ifdef FRAMELET_SANITIZE_ADDRESS
TEST(PerThread, LeakCheckersSeeWhatAValueHolds) {
    PerThread<std::vector<char>> buffers;
    buffers.prepare();
    tbb::parallel_for(0, 1000, [&](int) { buffers.local().resize(70000); });
    EXPECT_EQ(__lsan_do_recoverable_leak_check(), 0);
}
#endif

} // namespace
} // namespace framelet
