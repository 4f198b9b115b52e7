// Memory that runs out at a chosen allocation. Whatever program links this has an operator new that counts, and fails
// where it is told to; likewise malloc where zstd, OpenSSL and libpng call it. For tests only.
#pragma once

#include <cstdint>
#include <vector>

namespace framelet::test {

/// Makes the `number`th allocation of all threads together from here on fail (throw std::bad_alloc, or return null
/// where it is malloc's), and the `more` after it; 1 is the next one. Threads within `SparedFromFailure` are not
/// counted, and Embree's do not fail. Ends with its scope.
class FailingAllocation {
public:
    explicit FailingAllocation(std::uint64_t number, std::uint64_t more = 0);
    ~FailingAllocation();
    FailingAllocation(FailingAllocation const&) = delete;
    FailingAllocation& operator=(FailingAllocation const&) = delete;

    /// True once an allocation was to fail.
    bool has_failed() const;
    /// Allocations that have been counted so far, failed ones included.
    std::uint64_t count() const;
    /// Suspends it or lets it go on: while it is suspended no thread's allocations count or fail.
    void suspend(bool suspended);
};

/// Spares a thread: in its scope this thread's allocations neither count nor fail.
class SparedFromFailure {
public:
    SparedFromFailure();
    ~SparedFromFailure();
    SparedFromFailure(SparedFromFailure const&) = delete;
    SparedFromFailure& operator=(SparedFromFailure const&) = delete;

private:
    bool const before_;
};

/// Allocations that have not been given back, of the whole process.
std::int64_t live_allocations();

/// Numbers of allocations of `count` that are to fail: all of the first ones, then ever fewer, about `samples`
/// together. The last one is beyond all, so that nothing fails.
std::vector<std::uint64_t> sampled_allocations(std::uint64_t count, std::size_t samples);

} // namespace framelet::test
