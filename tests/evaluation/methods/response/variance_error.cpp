#include "tests/evaluation/methods/response/variance_error.h"

#include <algorithm>
#include <bit>

#include "common/error.h"
#include "tests/evaluation/methods/response/energy.h"

namespace framelet {
namespace {

constexpr std::size_t smallest_block = 4; // samples of the smallest block that has a variance

float variance(std::span<float const> samples) {
    float const share = 1 / static_cast<float>(samples.size());
    float const mean = share * sum_of(samples.size(), [&](std::size_t i) { return samples[i]; });
    return share * sum_of(samples.size(), [&](std::size_t i) { return (samples[i] - mean) * (samples[i] - mean); });
}

float mean_square_difference(std::span<float const> a, std::span<float const> b) {
    return sum_of(a.size(), [&](std::size_t i) { return (a[i] - b[i]) * (a[i] - b[i]); }) /
           static_cast<float>(a.size());
}

} // namespace

void estimate_variance(std::span<float const> samples, VarianceHistory& history, float seconds_since,
                       RateTemplates const& templates, std::span<RateError> elements) {
    FRAMELET_CHECK(!elements.empty() && samples.size() >= smallest_block && samples.size() % elements.size() == 0);
    bool const has_history = !history.values.empty();
    FRAMELET_CHECK(!has_history || (history.values.size() == samples.size() && seconds_since > 0));
    float const space_allowed = energy_allowed(templates.space, 0);
    std::size_t const width = samples.size() / elements.size();
    std::size_t const space_width = std::max(width, smallest_block);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        std::size_t const first = i * width / space_width * space_width;
        elements[i] = {compare_energies(variance(samples.subspan(first, space_width)), space_allowed), 0};
    }
    if (has_history) {
        float const allowed = energy_allowed(templates.time, octave_of_interval(seconds_since));
        std::span<float const> const old = history.values;
        for (std::size_t i = 0; i < elements.size(); ++i) {
            float const energy =
                mean_square_difference(samples.subspan(i * width, width), old.subspan(i * width, width));
            elements[i].time = compare_energies(energy, allowed);
        }
    }
    history.values.assign(samples.begin(), samples.end());
}

} // namespace framelet
