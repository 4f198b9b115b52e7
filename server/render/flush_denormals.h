// Embree asks for denormal numbers to be flushed to zero in every thread that traces or builds; results then also do
// not depend on what a thread was set to before.
#pragma once

#include <immintrin.h>

namespace framelet {

/// Sets flush-to-zero and denormals-are-zero for as long as it lives, on this thread.
class FlushDenormals {
public:
    FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | flush_to_zero | denormals_are_zero); }
    ~FlushDenormals() { _mm_setcsr(before_); }
    FlushDenormals(FlushDenormals const&) = delete;
    FlushDenormals& operator=(FlushDenormals const&) = delete;

private:
    static constexpr unsigned flush_to_zero = 1u << 15;
    static constexpr unsigned denormals_are_zero = 1u << 6;
    unsigned before_;
};

} // namespace framelet
