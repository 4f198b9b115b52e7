// Takes exceptions past a library that must not see them: what one of its callbacks throws is held until the library
// has returned. In: calls, from any thread. Out: whether to go on; afterwards the exception.
#pragma once

#include <exception>
#include <mutex>
#include <utility>

namespace framelet {

class HeldException {
public:
    /// Makes the call, one at a time. False where this or an earlier one has thrown: the library is to stop. Nothing is
    /// called any more then.
    template <typename Call>
    bool call(Call const& call) noexcept {
        std::scoped_lock const lock(mutex_);
        if (!thrown_) {
            try {
                call();
            } catch (...) {
                thrown_ = std::current_exception();
            }
        }
        return !thrown_;
    }

    /// Throws what was thrown, if anything was. It is called once the library has returned.
    void rethrow() {
        if (thrown_) {
            std::rethrow_exception(std::exchange(thrown_, nullptr));
        }
    }

private:
    std::mutex mutex_;
    std::exception_ptr thrown_;
};

} // namespace framelet
