#include "tests/evaluation/charts/real_dft.h"

#include <cmath>
#include <mutex>
#include <numbers>

#include <fftw3.h>

#include "common/error.h"

namespace framelet::bench {
namespace {

/// FFTW executes side by side but plans one at a time.
std::mutex& planner() {
    static std::mutex mutex;
    return mutex;
}

} // namespace

RealDft::RealDft(std::vector<int> const& sizes, int howmany) {
    int signal = 1;
    for (int const size : sizes) {
        signal *= size;
    }
    int const transform = signal / sizes.back() * (sizes.back() / 2 + 1);
    auto const count = static_cast<std::size_t>(howmany);
    signal_.reset(fftw_alloc_real(static_cast<std::size_t>(signal) * count));
    transform_.reset(fftw_alloc_real(2 * static_cast<std::size_t>(transform) * count));
    FRAMELET_CHECK(signal_ && transform_);
    std::lock_guard const lock(planner());
    plan_ =
        fftw_plan_many_dft_r2c(static_cast<int>(sizes.size()), sizes.data(), howmany, signal_.get(), nullptr, 1, signal,
                               reinterpret_cast<fftw_complex*>(transform_.get()), nullptr, 1, transform, FFTW_ESTIMATE);
    FRAMELET_CHECK(plan_ != nullptr);
}

RealDft::~RealDft() {
    std::lock_guard const lock(planner());
    fftw_destroy_plan(plan_);
}

void RealDft::execute() {
    fftw_execute(plan_);
}

void RealDft::Free::operator()(double* memory) const {
    fftw_free(memory);
}

std::vector<double> hann(int size) {
    std::vector<double> window(static_cast<std::size_t>(size));
    for (std::size_t i = 0; i < window.size(); ++i) {
        double const sine = std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / size);
        window[i] = sine * sine;
    }
    return window;
}

} // namespace framelet::bench
