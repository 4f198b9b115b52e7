#include "protocol/haar_planes.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "common/error.h"
#include "protocol/haar_transform.h"

namespace framelet {
namespace {

constexpr std::size_t octaves = 4;
/// Of an octave, from the finest (0).
constexpr std::size_t places(std::size_t octave) {
    return std::size_t{framelet_samples} >> (2 * (octave + 1));
}
/// Details of the octaves of one plane, the coarsest first, each [0, h, v, d] a place.
constexpr std::array<std::size_t, octaves> first_four{84, 20, 4, 0};

/// Quantisation step of the plane's mean and of its coarsest octave, sixteenths; it doubles with each finer one, as the
/// orthonormal transform has it. Errors of Y and Cg count three times in red, green and blue, those of Co twice.
std::uint16_t base_step(std::size_t plane, unsigned quality) {
    return static_cast<std::uint16_t>(plane == 1 ? (5 * quality + 2) / 4 : quality);
}
std::uint16_t octave_step(std::uint16_t base, std::size_t octave) {
    return static_cast<std::uint16_t>(base << (octaves - 1 - octave));
}

/// Smallest share of a step that rounds up, in 64ths: what is nearer to zero costs more bytes than it removes error.
constexpr unsigned detail_rounding = 22, mean_rounding = 32;

/// Levels of details, the means between them cleared.
void quantise_details(std::int16_t* fours, std::size_t count, unsigned step) {
    if (step == 1) { // they are levels; its reciprocal would not fit 16 bits
        for (std::size_t i = 0; i < count; i += 4) {
            fours[i] = 0;
        }
        return;
    }
    // floor(x / step) of 16-bit x, or one more where x is just below a multiple.
    auto const reciprocal = static_cast<std::uint16_t>(65536 / step + 1);
    auto const rounding = static_cast<std::uint16_t>(step * detail_rounding / 64);
    for (std::size_t i = 0; i < count; ++i) { // many at a time: products of 16 bits
        std::int16_t const value = fours[i];
        auto const sign = static_cast<std::int16_t>(value >> 15);
        auto const size = static_cast<std::uint16_t>(static_cast<std::uint16_t>((value ^ sign) - sign) + rounding);
        auto const level = static_cast<std::int16_t>(size * unsigned{reciprocal} >> 16);
        fours[i] = static_cast<std::int16_t>(i % 4 == 0 ? 0 : (level ^ sign) - sign);
    }
}

std::int16_t quantised_mean(int value, int step) {
    int const size = ((value < 0 ? -value : value) + step * static_cast<int>(mean_rounding) / 64) / step;
    return static_cast<std::int16_t>(value < 0 ? -size : size);
}

/// Values of a plane from its mean and its details, which are overwritten.
void synthesise(std::array<std::int16_t, HaarLevels::four_values>& fours, std::int16_t mean,
                std::array<std::int16_t, framelet_samples>& values) {
    std::int16_t const* means = &mean;
    for (std::size_t octave = octaves; octave-- > 0;) {
        haar_inverse(means, &fours[first_four[octave]], places(octave));
        means = &fours[first_four[octave]];
    }
    std::copy(means, means + framelet_samples, values.begin());
}

std::int16_t times(std::int16_t level, std::uint16_t step) {
    return static_cast<std::int16_t>(static_cast<std::uint16_t>(static_cast<std::uint16_t>(level) * unsigned{step}));
}

/// Roughly what levels take behind the entropy stage.
int bits_of(std::int16_t const* levels, std::size_t count) {
    constexpr std::int16_t any = 5, most = 8;
    using Lanes [[gnu::vector_size(32)]] = std::int16_t;
    constexpr std::size_t lanes = sizeof(Lanes) / sizeof(std::int16_t);
    Lanes sums{};
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        Lanes level;
        std::memcpy(&level, levels + i, sizeof level);
        Lanes const sign = level < 0, there = level != 0;
        Lanes const size = (level ^ sign) - sign;
        Lanes const large = size > most;
        sums += (size & ~large) + (large & most) + (there & any);
    }
    int bits = 0;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        bits += sums[lane];
    }
    for (; i < count; ++i) {
        int const size = std::abs(int{levels[i]});
        bits += std::min(size, int{most}) + (size == 0 ? 0 : any);
    }
    return bits;
}

} // namespace

HaarLevels quantise(DisplayValues const& values, std::uint8_t quality) {
    HaarLevels levels;
    for (std::size_t plane = 0; plane < 3; ++plane) {
        auto& fours = levels.details[plane];
        std::uint16_t const base = base_step(plane, quality);
        std::copy(values.planes[plane].begin(), values.planes[plane].end(), fours.begin() + first_four[0]);
        std::int16_t mean = 0;
        for (std::size_t octave = 0; octave < octaves; ++octave) {
            std::int16_t* const means = octave + 1 < octaves ? &fours[first_four[octave + 1]] : &mean;
            haar_forward(&fours[first_four[octave]], means, places(octave));
            quantise_details(&fours[first_four[octave]], 4 * places(octave), octave_step(base, octave));
        }
        levels.means[plane] = quantised_mean(mean, base);
    }
    return levels;
}

DisplayValues dequantise(HaarLevels const& levels, std::uint8_t quality) {
    DisplayValues values;
    for (std::size_t plane = 0; plane < 3; ++plane) {
        auto fours = levels.details[plane];
        std::uint16_t const base = base_step(plane, quality);
        for (std::size_t octave = 0; octave < octaves; ++octave) {
            std::uint16_t const step = octave_step(base, octave);
            std::int16_t* const of_octave = &fours[first_four[octave]];
            std::transform(of_octave, of_octave + 4 * places(octave), of_octave,
                           [step](std::int16_t level) { return times(level, step); });
        }
        synthesise(fours, times(levels.means[plane], base), values.planes[plane]);
    }
    return values;
}

int expected_bits(HaarLevels const& levels) {
    int bits = bits_of(levels.means.data(), levels.means.size());
    for (auto const& details : levels.details) {
        bits += bits_of(details.data(), details.size());
    }
    return bits;
}

HaarWriter::HaarWriter(Memory& memory, std::size_t count)
    : memory_(memory), count_(count),
      coarse_((memory.coarse.resize(most_token_bytes(coarse_details) * count), memory.coarse.data())),
      fine_((memory.fine.resize(most_token_bytes(fine_details) * count), memory.fine.data())) {
    memory.means.resize(mean_bytes * count);
    memory.escapes.resize(most_escape_bytes(coarse_details + fine_details) * count);
    escapes_ = memory.escapes.data();
}

void HaarWriter::put_mean(std::size_t plane, std::int16_t level) {
    auto const bits = static_cast<std::uint16_t>(level);
    std::size_t const i = plane * count_ + written_;
    memory_.means[i] = static_cast<std::uint8_t>(bits);
    memory_.means[3 * count_ + i] = static_cast<std::uint8_t>(bits >> 8);
}

void HaarWriter::write(HaarLevels const& levels) {
    for (std::size_t plane = 0; plane < 3; ++plane) {
        put_mean(plane, levels.means[plane]);
        std::int16_t const* const fours = levels.details[plane].data();
        escapes_ = coarse_.write(fours, first_four[0] / 4, escapes_);
        escapes_ = fine_.write(fours + first_four[0], places(0), escapes_);
    }
    ++written_;
}

std::int16_t HaarReader::mean(std::size_t plane) const {
    std::size_t const i = plane * (means_.size() / mean_bytes) + read_;
    return static_cast<std::int16_t>(means_[i] | means_[means_.size() / 2 + i] << 8);
}

DisplayValues HaarReader::read(std::uint8_t quality) {
    DisplayValues values;
    for (std::size_t plane = 0; plane < 3; ++plane) {
        std::array<std::int16_t, HaarLevels::four_values> fours{};
        std::uint16_t const base = base_step(plane, quality);
        for (std::size_t octave = octaves; octave-- > 0;) {
            TokenReader& reader = octave == 0 ? fine_ : coarse_;
            reader.read(&fours[first_four[octave]], places(octave), octave_step(base, octave), escapes_);
        }
        synthesise(fours, times(mean(plane), base), values.planes[plane]);
    }
    ++read_;
    return values;
}

} // namespace framelet
