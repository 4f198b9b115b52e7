#include "tests/evaluation/estimators/ideal_density.h"

#include <algorithm>

#include "common/error.h"
#include "tests/evaluation/charts/real_dft.h"

namespace framelet::bench {
namespace {

/// How often a bin of the last axis stands in the whole transform: the other half is its mirror image.
double multiplicity(int bin, int size) {
    return bin == 0 || 2 * bin == size ? 1 : 2;
}

/// Mean square of each time's picture by max(|u|, |v|) in half cycles per side.
std::vector<double> spatial_energies(SampleVolume const& volume) {
    int const side = volume.side, mirrored = 2 * side;
    auto const n = static_cast<std::size_t>(side), m = static_cast<std::size_t>(mirrored);
    RealDft dft({mirrored, mirrored}, 1);
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

/// Mean square of all samples' course in time, by cycles per window.
std::vector<double> temporal_energies(SampleVolume const& volume) {
    auto const pixels = static_cast<std::size_t>(volume.side) * static_cast<std::size_t>(volume.side);
    auto const times = static_cast<std::size_t>(volume.times);
    std::vector<double> const window = hann(volume.times);
    double sum = 0, squares = 0;
    for (double const weight : window) {
        sum += weight;
        squares += weight * weight;
    }
    RealDft dft({volume.times}, 1);
    std::vector<double> energies(times / 2 + 1);
    for (std::size_t i = 0; i < pixels; ++i) {
        double mean = 0;
        for (std::size_t t = 0; t < times; ++t) {
            mean += window[t] * volume.luma[t * pixels + i];
        }
        mean /= sum;
        for (std::size_t t = 0; t < times; ++t) {
            dft.signal()[t] = window[t] * (volume.luma[t * pixels + i] - mean);
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

/// The bin, with a fraction, beyond which no more than allowed is left.
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
    FRAMELET_CHECK(volume.luma.size() == static_cast<std::size_t>(volume.side) * static_cast<std::size_t>(volume.side) *
                                             static_cast<std::size_t>(volume.times));
    IdealDensity ideal;
    ideal.space_frequency = edge_of(spatial_energies(volume), parameters) / (2 * volume.pixels);
    ideal.time_frequency = edge_of(temporal_energies(volume), parameters) / volume.seconds;
    return ideal;
}

} // namespace framelet::bench
