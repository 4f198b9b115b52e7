#include "server/response/haar_error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "common/error.h"

namespace framelet {
namespace {

constexpr std::size_t most_blocks = 256; // of 2x2 samples, in a framelet of 32x32

using Blocks = std::array<float, most_blocks>;

bool is_square(std::size_t count) {
    return std::has_single_bit(count) && std::countr_zero(count) % 2 == 0;
}

/// One octave: the transform of each 2x2 block, the step in time against `cached`, which is replaced. `cached`: the
/// four quadrants hh, gh, hg, gg, each in Morton order (004 fig. 5.15: packed apart, so that hh is the next octave's
/// input).
template <bool has_history>
void transform(float const* input, std::size_t blocks, float* cached, Blocks& low, Blocks& space, Blocks& time) {
    for (std::size_t i = 0; i < blocks; ++i) {
        float const a = input[4 * i], b = input[4 * i + 1], c = input[4 * i + 2], d = input[4 * i + 3];
        float const hh = 0.25f * ((a + b) + (c + d));
        float const gh = 0.25f * ((a - b) + (c - d));
        float const hg = 0.25f * ((a + b) - (c + d));
        float const gg = 0.25f * ((a - b) - (c - d));
        if constexpr (has_history) {
            float const old_hh = cached[i], old_gh = cached[i + blocks];
            float const old_hg = cached[i + 2 * blocks], old_gg = cached[i + 3 * blocks];
            float const ghh = 0.5f * (gh + old_gh), hgh = 0.5f * (hg + old_hg), ggh = 0.5f * (gg + old_gg);
            float const hhg = 0.5f * (hh - old_hh), ghg = 0.5f * (gh - old_gh), hgg = 0.5f * (hg - old_hg);
            low[i] = 0.5f * (hh + old_hh);
            space[i] = ghh * ghh + hgh * hgh + ggh * ggh;
            time[i] = hhg * hhg + ghg * ghg + hgg * hgg;
        } else {
            low[i] = hh;
            space[i] = gh * gh + hg * hg + gg * gg;
        }
        cached[i] = hh;
        cached[i + blocks] = gh;
        cached[i + 2 * blocks] = hg;
        cached[i + 3 * blocks] = gg;
    }
}

/// Adds the signed difference of an octave to each element's error: localised level-wise norm against the template.
void add_differences(std::span<float const> energies, float allowed, float weight, std::span<RateError> elements,
                     float RateError::*axis) {
    if (elements.size() >= energies.size()) {
        std::size_t const width = elements.size() / energies.size();
        for (std::size_t i = 0; i < elements.size(); ++i) {
            float const energy = energies[i / width];
            elements[i].*axis += weight * (energy - allowed) / (energy + allowed);
        }
        return;
    }
    std::size_t const width = energies.size() / elements.size();
    float const share = 1 / static_cast<float>(width);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        float sum = 0;
        for (float const energy : energies.subspan(i * width, width)) {
            sum += energy;
        }
        float const energy = sum * share;
        elements[i].*axis += weight * (energy - allowed) / (energy + allowed);
    }
}

} // namespace

void estimate_haar(std::span<float const> samples, HaarHistory& history, float seconds_since,
                   RateTemplates const& templates, std::span<RateError> elements) {
    FRAMELET_CHECK(is_square(samples.size()) && samples.size() >= 4 && samples.size() <= 4 * most_blocks);
    FRAMELET_CHECK(is_square(elements.size()) && elements.size() <= samples.size());
    std::size_t const coefficients = 4 * (samples.size() - 1) / 3; // of all octaves
    bool const has_history = !history.values.empty();
    FRAMELET_CHECK(!has_history || (history.values.size() == coefficients && seconds_since > 0));
    history.values.resize(coefficients);
    std::fill(elements.begin(), elements.end(), RateError{});

    float const weight = 2 / static_cast<float>(std::countr_zero(samples.size())); // 1 / octaves
    float space_allowed = std::exp2(templates.space.offset);
    float const space_step = std::exp2(templates.space.slope);
    float const time_step = std::exp2(templates.time.slope);
    float time_allowed = 0;
    if (has_history) {
        float const octaves = std::log2(seconds_since / template_interval);
        time_allowed = std::exp2(templates.time.offset + templates.time.slope * octaves);
    }

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
        input = output.data();
        cached += 4 * blocks;
    }
}

} // namespace framelet
