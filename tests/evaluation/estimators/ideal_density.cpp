#include "tests/evaluation/estimators/ideal_density.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <mutex>
#include <numbers>

#include <fftw3.h>

#include "common/error.h"

namespace framelet::bench {
namespace {

/// Guards FFTW's planner: transforms may be executed in parallel, but are planned one at a time.
std::mutex& planner() {
    static std::mutex mutex;
    return mutex;
}

/// A real signal of some sizes (slowest first) and its transform, of which the last size is n/2 + 1.
class RealDft {
public:
    explicit RealDft(std::vector<int> const& sizes) {
        std::size_t samples = 1;
        for (int const size : sizes) {
            samples *= static_cast<std::size_t>(size);
        }
        auto const last = static_cast<std::size_t>(sizes.back());
        signal_.reset(fftw_alloc_real(samples));
        transform_.reset(fftw_alloc_real(2 * (samples / last) * (last / 2 + 1)));
        FRAMELET_CHECK(signal_ && transform_);
        std::lock_guard const lock(planner());
        plan_ = fftw_plan_dft_r2c(static_cast<int>(sizes.size()), sizes.data(), signal_.get(),
                                  reinterpret_cast<fftw_complex*>(transform_.get()), FFTW_ESTIMATE);
        FRAMELET_CHECK(plan_ != nullptr);
    }
    ~RealDft() {
        std::lock_guard const lock(planner());
        fftw_destroy_plan(plan_);
    }
    RealDft(RealDft const&) = delete;
    RealDft& operator=(RealDft const&) = delete;

    double* signal() { return signal_.get(); }
    void execute() { fftw_execute(plan_); }
    double power(std::size_t bin) const {
        return std::norm(std::complex(transform_[2 * bin], transform_[2 * bin + 1]));
    }

private:
    struct Free {
        void operator()(double* memory) const { fftw_free(memory); }
    };

    std::unique_ptr<double[], Free> signal_;
    std::unique_ptr<double[], Free> transform_; ///< real and imaginary parts in turn
    fftw_plan plan_ = nullptr;
};

/// A Hann window, sampled at the middle of its cells, so that none is zero.
std::vector<double> hann(int size) {
    std::vector<double> window(static_cast<std::size_t>(size));
    for (std::size_t i = 0; i < window.size(); ++i) {
        double const sine = std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / size);
        window[i] = sine * sine;
    }
    return window;
}

/// Returns how often a bin of the transform's last axis counts in the whole transform: the other half is its mirror
/// image.
double multiplicity(int bin, int size) {
    return bin == 0 || 2 * bin == size ? 1 : 2;
}

/// Mean square of the pictures of all times, less their means, by max(|u|, |v|) in half cycles per side.
std::vector<double> spatial_energies(SampleVolume const& volume) {
    int const side = volume.side, mirrored = 2 * side;
    auto const n = static_cast<std::size_t>(side), m = static_cast<std::size_t>(mirrored);
    RealDft dft({mirrored, mirrored});
    std::vector<double> energies(n + 1);
    for (int t = 0; t < volume.times; ++t) {
        float const* const picture = volume.luma.data() + static_cast<std::size_t>(t) * n * n;
        double mean = 0;
        for (std::size_t i = 0; i < n * n; ++i) {
            mean += picture[i];
        }
        mean /= static_cast<double>(n * n);
        for (std::size_t y = 0; y < m; ++y) {
            for (std::size_t x = 0; x < m; ++x) {
                dft.signal()[y * m + x] = picture[std::min(y, m - 1 - y) * n + std::min(x, m - 1 - x)] - mean;
            }
        }
        dft.execute();
        for (int v = 0; v < mirrored; ++v) {
            for (int u = 0; u <= side; ++u) {
                auto const band = static_cast<std::size_t>(std::max(u, std::min(v, mirrored - v)));
                auto const bin = static_cast<std::size_t>(v) * (n + 1) + static_cast<std::size_t>(u);
                energies[band] += multiplicity(u, mirrored) * dft.power(bin);
            }
        }
    }
    double const squared = static_cast<double>(m * m) * static_cast<double>(m * m);
    for (double& energy : energies) {
        energy /= squared * volume.times;
    }
    return energies;
}

/// Means of the samples of each pixel: [time][pixel].
std::vector<double> pixel_means(SampleVolume const& volume) {
    auto const side = static_cast<std::size_t>(volume.side), pixels = static_cast<std::size_t>(volume.pixels);
    std::size_t const per_pixel = side / pixels;
    std::vector<double> means(pixels * pixels * static_cast<std::size_t>(volume.times));
    for (std::size_t i = 0; i < volume.luma.size(); ++i) {
        std::size_t const x = i % side / per_pixel, y = i / side % side / per_pixel, t = i / (side * side);
        means[(t * pixels + y) * pixels + x] += volume.luma[i] / static_cast<double>(per_pixel * per_pixel);
    }
    return means;
}

/// Mean square of all pixels' variation in time, by cycles per window.
std::vector<double> temporal_energies(SampleVolume const& volume) {
    std::vector<double> const means = pixel_means(volume);
    auto const times = static_cast<std::size_t>(volume.times);
    std::size_t const pixels = means.size() / times;
    std::vector<double> const window = hann(volume.times);
    double sum = 0, squares = 0;
    for (double const weight : window) {
        sum += weight;
        squares += weight * weight;
    }
    RealDft dft({volume.times});
    std::vector<double> energies(times / 2 + 1);
    for (std::size_t i = 0; i < pixels; ++i) {
        double mean = 0;
        for (std::size_t t = 0; t < times; ++t) {
            mean += window[t] * means[t * pixels + i];
        }
        mean /= sum;
        for (std::size_t t = 0; t < times; ++t) {
            dft.signal()[t] = window[t] * (means[t * pixels + i] - mean);
        }
        dft.execute();
        for (std::size_t bin = 0; bin < energies.size(); ++bin) {
            energies[bin] += multiplicity(static_cast<int>(bin), volume.times) * dft.power(bin);
        }
    }
    for (double& energy : energies) {
        energy /= static_cast<double>(times) * squares * static_cast<double>(pixels);
    }
    return energies;
}

/// The bin, with a fraction, beyond which no more energy than allowed is left.
double edge_of(std::vector<double> const& energies, OracleParameters const& parameters) {
    double total = 0;
    for (double const energy : energies) {
        total += energy;
    }
    double const allowed = std::max((1 - parameters.share) * total, parameters.floor);
    double beyond = 0;
    for (std::size_t bin = energies.size(); bin-- > 1;) {
        if (beyond + energies[bin] > allowed) {
            return static_cast<double>(bin) - (allowed - beyond) / energies[bin];
        }
        beyond += energies[bin];
    }
    return 0;
}

} // namespace

IdealDensity ideal_density(SampleVolume const& volume, OracleParameters const& parameters) {
    FRAMELET_CHECK(volume.pixels > 0 && volume.side % volume.pixels == 0);
    FRAMELET_CHECK(volume.luma.size() == static_cast<std::size_t>(volume.side) * static_cast<std::size_t>(volume.side) *
                                             static_cast<std::size_t>(volume.times));
    IdealDensity ideal;
    ideal.space_frequency = edge_of(spatial_energies(volume), parameters) / (2.0 * volume.pixels);
    ideal.time_frequency = edge_of(temporal_energies(volume), parameters) / volume.seconds;
    return ideal;
}

} // namespace framelet::bench
