// A value of its own for every thread of a loop.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <tbb/task_arena.h>

namespace framelet {

/// A value for each thread of a loop. TBB's own class for this destroys values that it has never made where memory runs
/// out, and leak checkers do not search its memory.
template <typename Value>
class PerThread {
public:
    /// Makes room for all threads that may take part in a loop of the caller's; to be called before each loop that asks
    /// for values.
    void prepare() {
        auto const threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) + 1;
        if (values_.size() < threads) {
            values_.resize(threads);
        }
    }

    /// The calling thread's value, made when it first asks.
    Value& local() {
        int const index = std::max(tbb::this_task_arena::current_thread_index(), 0); // negative before any loop
        std::unique_ptr<Value>& value = values_.at(static_cast<std::size_t>(index));
        if (value == nullptr) {
            value = std::make_unique<Value>();
        }
        return *value;
    }

    /// Calls `see(value)` for each value that was made. Not to be called while a loop runs.
    template <typename See>
    void for_each(See const& see) const {
        for (std::unique_ptr<Value> const& value : values_) {
            if (value != nullptr) {
                see(std::as_const(*value));
            }
        }
    }

    /// The same, and it may change them.
    template <typename Change>
    void change_each(Change const& change) {
        for (std::unique_ptr<Value> const& value : values_) {
            if (value != nullptr) {
                change(*value);
            }
        }
    }

private:
    std::vector<std::unique_ptr<Value>> values_;
};

} // namespace framelet
