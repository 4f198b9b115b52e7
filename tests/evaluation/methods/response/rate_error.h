// The answer of an error estimator: whether a place is sampled too rarely or too often, in space and in time apart.
#pragma once

#include <span>
#include <vector>

namespace framelet {

/// Sample-rate error ([Stephens 2011] ch. 5), each in [-1, 1]: above 0 undersampled, below 0 redundant.
struct RateError {
    float space = 0;
    float time = 0;

    bool operator==(RateError const&) const = default;
};

/// The energy that an octave may have, as a straight line: log2(energy) = offset + slope * octave, octave 0 the finest
/// of the framelet. More is undersampled, less is redundant.
struct EnergyTemplate {
    float offset = 0;
    float slope = 0;

    bool operator==(EnergyTemplate const&) const = default;
};

struct RateTemplates {
    EnergyTemplate space;
    EnergyTemplate time;

    bool operator==(RateTemplates const&) const = default;
};

/// Seconds between refreshes at which the template in time counts a framelet's finest octave as octave 0; refreshes
/// twice as far apart are an octave coarser. So the template is a line over frequency, whatever the rate.
inline constexpr float template_interval = 1.0f / 60;

/// Values that an estimator keeps of a place between its framelets. Empty: there was none yet.
struct ErrorHistory {
    std::vector<float> values;

    bool operator==(ErrorHistory const&) const = default;
};

} // namespace framelet
