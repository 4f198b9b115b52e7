// Lets memory run out while several threads ask for values of their own.
#include <atomic>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include "common/per_thread.h"
#include "tests/faults/failing_allocations.h"

namespace framelet::test {
namespace {

TEST(PerThreadAllocation, FailsAndNothingIsDestroyedThatWasNotMade) {
    tbb::global_control const threads(tbb::global_control::max_allowed_parallelism, 4);
    std::atomic<int> started = 0;
    tbb::parallel_for(0, 10'000, [&](int) { ++started; }); // starting the threads now: that would not survive a failure
    int failures = 0;
    for (int turn = 0; turn < 3000; ++turn) {
        for (std::uint64_t number = 1; number <= 14; ++number) {
            std::optional<PerThread<std::vector<int>>> values(std::in_place);
            FailingAllocation const fails(number);
            try {
                values->prepare();
                tbb::parallel_for(0, 64, [&](int) {
                    for (int i = 0; i < 100; ++i) {
                        ++started; // takes time, so that other threads come to take a part
                    }
                    std::vector<int>& own = values->local();
                    own.resize(own.size() + 1);
                });
                EXPECT_FALSE(fails.has_failed());
            } catch (std::bad_alloc const&) {
                ++failures;
            }
        }
    }
    EXPECT_GT(failures, 3000);
}

} // namespace
} // namespace framelet::test
