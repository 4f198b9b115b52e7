// Fourier transforms of real signals, and the window they are looked at through.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

struct fftw_plan_s;

namespace framelet::bench {

/// Real signals of one size and their transforms, memory and plan. May be made and used on any thread.
class RealDft {
public:
    /// `howmany` signals one after the other, of `sizes` (slowest first). The transform of each has the same sizes, but
    /// the last one n/2 + 1.
    RealDft(std::vector<int> const& sizes, int howmany);
    ~RealDft();
    RealDft(RealDft const&) = delete;
    RealDft& operator=(RealDft const&) = delete;

    double* signal() { return signal_.get(); }
    void execute();
    double power(std::size_t i) const {
        double const* const value = transform_.get() + 2 * i;
        return value[0] * value[0] + value[1] * value[1];
    }

private:
    struct Free {
        void operator()(double* memory) const;
    };

    std::unique_ptr<double[], Free> signal_;
    std::unique_ptr<double[], Free> transform_; ///< real and imaginary parts in turn
    fftw_plan_s* plan_ = nullptr;
};

/// Hann window, sampled at the middle of its cells, so that none is zero.
std::vector<double> hann(int size);

} // namespace framelet::bench
