#include "protocol/haar_planes.h"

#include <algorithm>

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
constexpr std::size_t four_values = 4 * (64 + 16 + 4 + 1);

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
void quantise(std::int16_t* fours, std::size_t count, unsigned step) {
    // floor(x / step) of 16-bit x, or one more where x is just below a multiple.
    unsigned const reciprocal = 65536 / step + 1;
    unsigned const rounding = step * detail_rounding / 64;
    for (std::size_t i = 0; i < count; ++i) {
        int const value = fours[i];
        unsigned const size = static_cast<unsigned>(value < 0 ? -value : value);
        auto const level = static_cast<int>((size + rounding) * reciprocal >> 16);
        fours[i] = static_cast<std::int16_t>(i % 4 == 0 ? 0 : value < 0 ? -level : level);
    }
}

std::int16_t quantised_mean(int value, int step) {
    int const size = ((value < 0 ? -value : value) + step * static_cast<int>(mean_rounding) / 64) / step;
    return static_cast<std::int16_t>(value < 0 ? -size : size);
}

} // namespace

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

void HaarWriter::write(DisplayFramelet const& framelet, std::uint8_t quality) {
    DisplayValues const values = display_values(framelet);
    for (std::size_t plane = 0; plane < 3; ++plane) {
        std::array<std::int16_t, four_values + 1> fours; // octaves, the mean behind the last
        std::uint16_t const base = base_step(plane, quality);
        std::copy(values.planes[plane].begin(), values.planes[plane].end(), fours.begin() + first_four[0]);
        std::int16_t mean = 0;
        for (std::size_t octave = 0; octave < octaves; ++octave) {
            std::int16_t* const means = octave + 1 < octaves ? &fours[first_four[octave + 1]] : &mean;
            haar_forward(&fours[first_four[octave]], means, places(octave));
            quantise(&fours[first_four[octave]], 4 * places(octave), octave_step(base, octave));
        }
        put_mean(plane, quantised_mean(mean, base));
        escapes_ = coarse_.write(fours.data(), first_four[0] / 4, escapes_);
        escapes_ = fine_.write(&fours[first_four[0]], places(0), escapes_);
    }
    ++written_;
}

std::int16_t HaarReader::mean(std::size_t plane) const {
    std::size_t const i = plane * (means_.size() / mean_bytes) + read_;
    return static_cast<std::int16_t>(means_[i] | means_[means_.size() / 2 + i] << 8);
}

void HaarReader::read(DisplayFramelet& framelet, std::uint8_t quality) {
    DisplayValues values;
    for (std::size_t plane = 0; plane < 3; ++plane) {
        std::array<std::int16_t, four_values> fours{};
        std::uint16_t const base = base_step(plane, quality);
        for (std::size_t octave = octaves; octave-- > 0;) {
            TokenReader& reader = octave == 0 ? fine_ : coarse_;
            reader.read(&fours[first_four[octave]], places(octave), octave_step(base, octave), escapes_);
        }
        auto const mean_value = static_cast<std::int16_t>(static_cast<std::uint16_t>(unsigned(mean(plane)) * base));
        std::int16_t const* means = &mean_value;
        for (std::size_t octave = octaves; octave-- > 0;) {
            haar_inverse(means, &fours[first_four[octave]], places(octave));
            means = &fours[first_four[octave]];
        }
        std::copy(means, means + framelet_samples, values.planes[plane].begin());
    }
    to_samples(values, framelet);
    ++read_;
}

} // namespace framelet
