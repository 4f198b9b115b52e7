#include "server/response/variance_error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "common/error.h"

namespace framelet {
namespace {

constexpr std::size_t smallest_block = 4; // that has a variance

/// Sum of value(i), i < count, in several partial sums, which the compiler keeps in one vector.
template <class Value>
float sum_of(std::size_t count, Value&& value) {
    constexpr std::size_t lanes = 16;
    float sum = 0;
    std::size_t i = 0;
    if (count >= lanes) {
        std::array<float, lanes> partial{};
        for (; i + lanes <= count; i += lanes) {
            for (std::size_t lane = 0; lane < lanes; ++lane) {
                partial[lane] += value(i + lane);
            }
        }
        for (float const part : partial) {
            sum += part;
        }
    }
    for (; i < count; ++i) {
        sum += value(i);
    }
    return sum;
}

float variance(std::span<float const> samples) {
    float const share = 1 / static_cast<float>(samples.size());
    float const mean = share * sum_of(samples.size(), [&](std::size_t i) { return samples[i]; });
    return share * sum_of(samples.size(), [&](std::size_t i) { return (samples[i] - mean) * (samples[i] - mean); });
}

float mean_square_difference(std::span<float const> a, std::span<float const> b) {
    return sum_of(a.size(), [&](std::size_t i) { return (a[i] - b[i]) * (a[i] - b[i]); }) /
           static_cast<float>(a.size());
}

float signed_difference(float energy, float allowed) {
    return (energy - allowed) / (energy + allowed);
}

} // namespace

void estimate_variance(std::span<float const> samples, VarianceHistory& history, float seconds_since,
                       RateTemplates const& templates, std::span<RateError> elements) {
    FRAMELET_CHECK(!elements.empty() && samples.size() >= smallest_block && samples.size() % elements.size() == 0);
    bool const has_history = !history.values.empty();
    FRAMELET_CHECK(!has_history || (history.values.size() == samples.size() && seconds_since > 0));
    float const space_allowed = std::exp2(templates.space.offset);
    std::size_t const width = samples.size() / elements.size();
    std::size_t const space_width = std::max(width, smallest_block);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        std::size_t const first = i * width / space_width * space_width;
        elements[i] = {signed_difference(variance(samples.subspan(first, space_width)), space_allowed), 0};
    }
    if (has_history) {
        float const octave = std::log2(seconds_since / template_interval);
        float const allowed = std::exp2(templates.time.offset + templates.time.slope * octave);
        std::span<float const> const old = history.values;
        for (std::size_t i = 0; i < elements.size(); ++i) {
            float const energy =
                mean_square_difference(samples.subspan(i * width, width), old.subspan(i * width, width));
            elements[i].time = signed_difference(energy, allowed);
        }
    }
    history.values.assign(samples.begin(), samples.end());
}

} // namespace framelet
