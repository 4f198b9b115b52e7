#include "protocol/codec/color/haar_planes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "protocol/codec/color/haar_transform.h"

namespace framelet {
namespace {

/// Quantisation step of the plane's mean and of its coarsest octave, sixteenths; it doubles with each finer one, as the
/// orthonormal transform has it. Errors of Y and Cg count three times in red, green and blue, those of Co twice.
std::uint16_t base_step(std::size_t plane, unsigned qp) {
    return static_cast<std::uint16_t>(plane == 1 ? (5 * qp + 2) / 4 : qp);
}
std::uint16_t octave_step(std::uint16_t base, std::size_t octave) {
    return static_cast<std::uint16_t>(base << (haar_octaves - 1 - octave));
}

std::int16_t quantised_mean(int value, int step) {
    int const size = (std::abs(value) + step / 2) / step;
    return static_cast<std::int16_t>(value < 0 ? -size : size);
}

std::int16_t times(std::int16_t level, std::uint16_t step) {
    return static_cast<std::int16_t>(static_cast<std::uint16_t>(static_cast<std::uint16_t>(level) * unsigned{step}));
}

/// Details of all octaves of a plane, from its levels.
PlaneDetails details_of(PlaneDetails const& levels, std::uint16_t base) {
    PlaneDetails details;
    for (std::size_t octave = 0; octave < haar_octaves; ++octave) {
        std::uint16_t const step = octave_step(base, octave);
        std::size_t const first = octave_first[octave];
        std::transform(&levels[first], &levels[first] + 4 * haar_blocks(octave), &details[first],
                       [step](std::int16_t level) { return times(level, step); });
    }
    return details;
}

/// Quantises the details of a plane; returns the bits that its levels take, roughly.
int quantise(PlaneDetails const& details, std::uint16_t base, PlaneDetails& levels) {
    int bits = 0;
    for (std::size_t octave = 0; octave < haar_octaves; ++octave) {
        std::size_t const first = octave_first[octave];
        bits += quantise(&details[first], haar_blocks(octave), DetailStep(octave_step(base, octave)), &levels[first]);
    }
    return bits;
}

int bits_of_level(std::int16_t level) {
    int const size = std::abs(int{level});
    return size == 0 ? 0 : std::min(size, int{most_bits_of_size}) + int{bits_of_any};
}

/// Part of a detail of chroma that comes from the detail of luma beside it; `share` is in eighths.
std::int16_t shared(std::int16_t luma, std::int8_t share) {
    return static_cast<std::int16_t>(times(luma, static_cast<std::uint16_t>(share)) >> 3);
}

/// Computes the values of a plane from its mean and its levels, which are overwritten. `base`: quantisation step of the
/// coarsest octave; 0 where the levels are details already.
void synthesise(PlaneDetails& levels, std::uint16_t base, std::int16_t mean, std::int16_t* values) {
    constexpr std::uint16_t one = 1;
    std::int16_t const* means = &mean;
    for (std::size_t octave = haar_octaves; octave-- > 0;) {
        std::int16_t* const octave_levels = &levels[octave_first[octave]];
        std::int16_t* const out = octave == 0 ? values : octave_levels;
        haar_inverse(means, octave_levels, base == 0 ? one : octave_step(base, octave), haar_blocks(octave), out);
        means = out;
    }
}

/// Values of the three planes of a framelet from its levels, which are overwritten.
DisplayValues synthesise(HaarLevels& levels, std::uint8_t qp) {
    DisplayValues out;
    std::array<std::uint16_t, 3> bases;
    std::array<std::int16_t, 3> means;
    for (std::size_t plane = 0; plane < bases.size(); ++plane) {
        bases[plane] = base_step(plane, qp);
        means[plane] = times(levels.means[plane], bases[plane]);
    }
    if (levels.shares[0] != 0 || levels.shares[1] != 0) {
        PlaneDetails const luma = details_of(levels.details[0], bases[0]);
        for (std::size_t chroma = 0; chroma < levels.shares.size(); ++chroma) {
            if (std::int8_t const share = levels.shares[chroma]; share != 0) {
                PlaneDetails& details = levels.details[1 + chroma];
                details = details_of(details, bases[1 + chroma]);
                std::transform(details.begin(), details.end(), luma.begin(), details.begin(),
                               [share](std::int16_t own, std::int16_t of_luma) {
                                   return static_cast<std::int16_t>(own + shared(of_luma, share));
                               });
                bases[1 + chroma] = 0;
            }
        }
    }
    for (std::size_t plane = 0; plane < bases.size(); ++plane) {
        synthesise(levels.details[plane], bases[plane], means[plane], out.planes[plane].data());
    }
    return out;
}

} // namespace

int code(DisplayValues const& values, std::uint8_t qp, int most, HaarCode& out) {
    int bits = 0;
    for (std::size_t plane = 0; plane < values.planes.size(); ++plane) {
        std::uint16_t const base = base_step(plane, qp);
        PlaneDetails& details = out.values[plane];
        PlaneDetails& levels = out.levels.details[plane];
        std::int16_t const* children = values.planes[plane].data();
        std::int16_t mean = 0;
        int const bits_before = bits;
        for (std::size_t octave = 0; octave < haar_octaves; ++octave) {
            std::size_t const first = octave_first[octave];
            std::int16_t* const means = octave + 1 < haar_octaves ? &details[octave_first[octave + 1]] : &mean;
            bits += haar_forward(children, haar_blocks(octave), DetailStep(octave_step(base, octave)), means,
                                 &details[first], &levels[first]);
            if (bits > most) {
                return bits;
            }
            children = means;
        }
        out.bits[plane] = bits - bits_before;
        out.levels.means[plane] = quantised_mean(mean, base);
        bits += bits_of_level(out.levels.means[plane]);
    }
    out.levels.shares = {};
    return bits;
}

namespace {

/// Fits by least squares how many eighths of luma, as it will be read, the details of chroma have. Each detail counts
/// as much as it does in the picture.
int fitted_share(PlaneDetails const& luma, PlaneDetails const& chroma) {
    float products = 0, squares = 0;
    for (std::size_t octave = 0; octave < haar_octaves; ++octave) {
        // The sums stay below 1.5e9: details of a block have at most the squares of its samples, 64 times 4080^2
        // together; rounding adds at most 349 to each of 192 of luma.
        std::int32_t product = 0, square = 0;
        for (std::size_t i = octave_first[octave]; i < octave_first[octave] + 4 * haar_blocks(octave); ++i) {
            product += luma[i] * chroma[i];
            square += luma[i] * luma[i];
        }
        auto const weight = static_cast<float>(1u << (2 * octave));
        products += weight * static_cast<float>(product);
        squares += weight * static_cast<float>(square);
    }
    constexpr float eighths = 8;
    return squares > 0 ? static_cast<int>(std::lround(std::clamp(eighths * products / squares, -8.0f, 7.0f))) : 0;
}

} // namespace

void share_luma(std::uint8_t qp, HaarCode& code) {
    HaarLevels& levels = code.levels;
    if (code.bits[0] == 0 || code.bits[1] + code.bits[2] == 0) {
        return; // nothing to share, or nobody to share it
    }
    PlaneDetails const luma = details_of(levels.details[0], base_step(0, qp));
    for (std::size_t chroma = 0; chroma < levels.shares.size(); ++chroma) {
        std::size_t const plane = 1 + chroma;
        if (code.bits[plane] == 0) {
            continue;
        }
        auto const share = static_cast<std::int8_t>(fitted_share(luma, code.values[plane]));
        if (share == 0) {
            continue;
        }
        PlaneDetails tried, tried_levels;
        std::transform(code.values[plane].begin(), code.values[plane].end(), luma.begin(), tried.begin(),
                       [share](std::int16_t own, std::int16_t of_luma) {
                           return static_cast<std::int16_t>(own - shared(of_luma, share));
                       });
        if (quantise(tried, base_step(plane, qp), tried_levels) < code.bits[plane]) {
            levels.details[plane] = tried_levels;
            levels.shares[chroma] = share;
        }
    }
}

DisplayValues dequantise(HaarLevels const& levels, std::uint8_t qp) {
    HaarLevels copy = levels;
    return synthesise(copy, qp);
}

} // namespace framelet
