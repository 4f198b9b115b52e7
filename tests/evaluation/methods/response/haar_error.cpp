#include "tests/evaluation/methods/response/haar_error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "common/error.h"
#include "tests/evaluation/methods/response/energy.h"

namespace framelet {
namespace {

constexpr std::size_t most_blocks = 256; // blocks of 2x2 samples in a framelet of 32x32

using Blocks = std::array<float, most_blocks>;

bool is_square(std::size_t count) {
    return std::has_single_bit(count) && std::countr_zero(count) % 2 == 0;
}

/// Transforms one octave: each 2x2 block, and the step in time against `cached`, which is replaced. `cached`: the four
/// quadrants hh, gh, hg, gg, each in Morton order ([Stephens 2011] fig. 5.15: packed apart, so that hh is the next
/// octave's input).
template <bool has_history>
void transform(float const* input, std::size_t blocks, float* cached, Blocks& low, Blocks& space, Blocks& time) {
    Blocks hh, gh, hg, gg; // no alias of what is read, so that the loops below are vectorised
    for (std::size_t i = 0; i < blocks; ++i) {
        float const a = input[4 * i], b = input[4 * i + 1], c = input[4 * i + 2], d = input[4 * i + 3];
        hh[i] = 0.25f * ((a + b) + (c + d));
        gh[i] = 0.25f * ((a - b) + (c - d));
        hg[i] = 0.25f * ((a + b) - (c + d));
        gg[i] = 0.25f * ((a - b) - (c - d));
    }
    if constexpr (has_history) {
        float const* const old = cached;
        for (std::size_t i = 0; i < blocks; ++i) {
            float const ghh = 0.5f * (gh[i] + old[i + blocks]);
            float const hgh = 0.5f * (hg[i] + old[i + 2 * blocks]);
            float const ggh = 0.5f * (gg[i] + old[i + 3 * blocks]);
            space[i] = ghh * ghh + hgh * hgh + ggh * ggh;
        }
        for (std::size_t i = 0; i < blocks; ++i) {
            float const hhg = 0.5f * (hh[i] - old[i]);
            float const ghg = 0.5f * (gh[i] - old[i + blocks]);
            float const hgg = 0.5f * (hg[i] - old[i + 2 * blocks]);
            time[i] = hhg * hhg + ghg * ghg + hgg * hgg;
            low[i] = 0.5f * (hh[i] + old[i]);
        }
    } else {
        for (std::size_t i = 0; i < blocks; ++i) {
            space[i] = gh[i] * gh[i] + hg[i] * hg[i] + gg[i] * gg[i];
        }
        std::copy_n(hh.begin(), blocks, low.begin());
    }
    for (Blocks const* const quadrant : {&hh, &gh, &hg, &gg}) {
        cached = std::copy_n(quadrant->begin(), blocks, cached);
    }
}

/// Adds the signed difference of an octave to each element's error: localised level-wise norm against the template.
void add_differences(std::span<float const> energies, float allowed, float weight, std::span<RateError> elements,
                     float RateError::*axis) {
    if (elements.size() >= energies.size()) {
        std::size_t const width = elements.size() / energies.size();
        for (std::size_t i = 0; i < elements.size(); ++i) {
            float const energy = energies[i / width];
            elements[i].*axis += weight * compare_energies(energy, allowed);
        }
        return;
    }
    std::size_t const width = energies.size() / elements.size();
    float const share = 1 / static_cast<float>(width);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        float const* const block = energies.data() + i * width;
        float const energy = share * sum_of(width, [&](std::size_t j) { return block[j]; });
        elements[i].*axis += weight * compare_energies(energy, allowed);
    }
}

} // namespace

void estimate_haar(std::span<float const> samples, HaarHistory& history, float seconds_since,
                   RateTemplates const& templates, std::span<RateError> elements) {
    FRAMELET_CHECK(is_square(samples.size()) && samples.size() >= 4 && samples.size() <= 4 * most_blocks);
    FRAMELET_CHECK(is_square(elements.size()) && elements.size() <= samples.size());
    std::size_t const coefficients = 4 * (samples.size() - 1) / 3; // number of coefficients of all octaves
    bool const has_history = !history.values.empty();
    FRAMELET_CHECK(!has_history || (history.values.size() == coefficients && seconds_since > 0));
    history.values.resize(coefficients);
    std::fill(elements.begin(), elements.end(), RateError{});

    int const octaves = std::countr_zero(samples.size()) / 2;
    float const weights = static_cast<float>((1 << octaves) - 1);
    // Weights are powers of two, so that their sums are exact and the bounds hold.
    float weight = static_cast<float>(1 << (octaves - 1));
    float space_allowed = energy_allowed(templates.space, 0);
    float const space_step = std::exp2(templates.space.slope);
    float const time_step = std::exp2(templates.time.slope);
    float time_allowed = has_history ? energy_allowed(templates.time, octave_of_interval(seconds_since)) : 0;

    std::array<Blocks, 2> low;
    Blocks space, time;
    float const* input = samples.data();
    float* cached = history.values.data();
    std::size_t octave = 0;
    for (std::size_t blocks = samples.size() / 4; blocks > 0; blocks /= 4, ++octave) {
        Blocks& output = low[octave % 2];
        if (has_history) {
            transform<true>(input, blocks, cached, output, space, time);
            add_differences({time.data(), blocks}, time_allowed, weight, elements, &RateError::time);
        } else {
            transform<false>(input, blocks, cached, output, space, time);
        }
        add_differences({space.data(), blocks}, space_allowed, weight, elements, &RateError::space);
        space_allowed *= space_step;
        time_allowed *= time_step;
        weight *= 0.5f;
        input = output.data();
        cached += 4 * blocks;
    }
    for (RateError& element : elements) {
        element = {element.space / weights, element.time / weights};
    }
}

} // namespace framelet
