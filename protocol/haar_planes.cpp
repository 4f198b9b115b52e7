#include "protocol/haar_planes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "common/error.h"
#include "protocol/haar_transform.h"
#include "protocol/zigzag.h"

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

std::int16_t times(std::int16_t level, std::uint16_t step) {
    return static_cast<std::int16_t>(static_cast<std::uint16_t>(static_cast<std::uint16_t>(level) * unsigned{step}));
}

/// Of all octaves of a plane, from its levels.
void dequantise(Fours& fours, std::uint16_t base) {
    for (std::size_t octave = 0; octave < octaves; ++octave) {
        std::uint16_t const step = octave_step(base, octave);
        std::int16_t* const of_octave = &fours[first_four[octave]];
        std::transform(of_octave, of_octave + 4 * places(octave), of_octave,
                       [step](std::int16_t level) { return times(level, step); });
    }
}

void quantise(Fours& fours, std::uint16_t base) {
    for (std::size_t octave = 0; octave < octaves; ++octave) {
        quantise_details(&fours[first_four[octave]], 4 * places(octave), octave_step(base, octave));
    }
}

/// What details of chroma have from those of luma.
std::int16_t shared(std::int16_t luma, std::int8_t share) {
    return static_cast<std::int16_t>(times(luma, static_cast<std::uint16_t>(share)) >> 3);
}

/// Values of the planes from their means and details, which are overwritten.
DisplayValues synthesise(std::array<Fours, 3>& details, std::array<std::int16_t, 3> const& plane_means,
                         std::array<std::int8_t, 2> const& shares) {
    for (std::size_t chroma = 0; chroma < shares.size(); ++chroma) {
        if (shares[chroma] != 0) {
            std::transform(details[1 + chroma].begin(), details[1 + chroma].end(), details[0].begin(),
                           details[1 + chroma].begin(), [share = shares[chroma]](std::int16_t own, std::int16_t luma) {
                               return static_cast<std::int16_t>(own + shared(luma, share));
                           });
        }
    }
    DisplayValues values;
    for (std::size_t plane = 0; plane < 3; ++plane) {
        std::int16_t const* means = &plane_means[plane];
        for (std::size_t octave = octaves; octave-- > 0;) {
            std::int16_t* const fours = &details[plane][first_four[octave]];
            std::int16_t* const out = octave == 0 ? values.planes[plane].data() : fours;
            haar_inverse(means, fours, places(octave), out);
            means = out;
        }
    }
    return values;
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

int code(DisplayValues const& values, std::uint8_t quality, int most, HaarCode& out) {
    int bits = 0;
    for (std::size_t plane = 0; plane < 3 && bits <= most; ++plane) {
        Fours& fours = out.values[plane];
        std::copy(values.planes[plane].begin(), values.planes[plane].end(), fours.begin() + first_four[0]);
        std::int16_t mean = 0;
        for (std::size_t octave = 0; octave < octaves; ++octave) {
            std::int16_t* const means = octave + 1 < octaves ? &fours[first_four[octave + 1]] : &mean;
            haar_forward(&fours[first_four[octave]], means, places(octave));
        }
        std::uint16_t const base = base_step(plane, quality);
        Fours& levels = out.levels.details[plane];
        levels = fours;
        quantise(levels, base);
        out.levels.means[plane] = quantised_mean(mean, base);
        bits += bits_of(levels.data(), levels.size()) + bits_of(&out.levels.means[plane], 1);
    }
    out.levels.shares = {};
    return bits;
}

namespace {

/// Least squares: how many eighths of luma, as it will be read, the details of chroma have. Each counts as much as it
/// does in the picture.
int fitted_share(Fours const& luma, Fours const& chroma) {
    float products = 0, squares = 0;
    for (std::size_t octave = 0; octave < octaves; ++octave) {
        float product = 0, square = 0;
        for (std::size_t i = first_four[octave]; i < first_four[octave] + 4 * places(octave); ++i) {
            auto const y = static_cast<float>(luma[i]);
            product += y * static_cast<float>(chroma[i]);
            square += y * y;
        }
        auto const weight = static_cast<float>(1u << (2 * octave));
        products += weight * product;
        squares += weight * square;
    }
    constexpr float eighths = 8;
    return squares > 0 ? static_cast<int>(std::lround(std::clamp(eighths * products / squares, -8.0f, 7.0f))) : 0;
}

} // namespace

void share_luma(std::uint8_t quality, HaarCode& code) {
    HaarLevels& levels = code.levels;
    Fours luma = levels.details[0];
    dequantise(luma, base_step(0, quality));
    for (std::size_t chroma = 0; chroma < levels.shares.size(); ++chroma) {
        std::size_t const plane = 1 + chroma;
        int const bits = bits_of(levels.details[plane].data(), levels.details[plane].size());
        auto const share = static_cast<std::int8_t>(bits > 0 ? fitted_share(luma, code.values[plane]) : 0);
        if (share == 0) {
            continue;
        }
        Fours tried = code.values[plane];
        for (std::size_t i = 0; i < tried.size(); ++i) {
            tried[i] = static_cast<std::int16_t>(tried[i] - shared(luma[i], share));
        }
        quantise(tried, base_step(plane, quality));
        if (bits_of(tried.data(), tried.size()) < bits) {
            levels.details[plane] = tried;
            levels.shares[chroma] = share;
        }
    }
}

DisplayValues dequantise(HaarLevels const& levels, std::uint8_t quality) {
    std::array<Fours, 3> details = levels.details;
    std::array<std::int16_t, 3> means;
    for (std::size_t plane = 0; plane < 3; ++plane) {
        std::uint16_t const base = base_step(plane, quality);
        dequantise(details[plane], base);
        means[plane] = times(levels.means[plane], base);
    }
    return synthesise(details, means, levels.shares);
}

namespace {

TokenWriter writer_of(HaarWriter::Memory& memory, std::size_t part, std::size_t framelets) {
    std::size_t const planes = part % 2 == 0 ? 1 : 2;
    std::size_t const details = planes * (part < 2 ? coarse_details : fine_details);
    memory.tokens[part].resize(most_token_bytes(details) * framelets);
    return TokenWriter(memory.tokens[part].data());
}

} // namespace

HaarWriter::HaarWriter(Memory& memory, std::size_t count)
    : memory_(memory), count_(count), writers_{writer_of(memory, 0, count), writer_of(memory, 1, count),
                                               writer_of(memory, 2, count), writer_of(memory, 3, count)} {
    memory.shares.resize(share_bytes * count);
    memory.means.resize(mean_bytes * count);
    memory.escapes.resize(most_escape_bytes(3 * (coarse_details + fine_details)) * count);
    escapes_ = memory.escapes.data();
}

void HaarWriter::put_mean(std::size_t plane, std::int16_t level) {
    auto const code = zigzag(level);
    std::size_t const i = plane * count_ + written_;
    memory_.means[i] = static_cast<std::uint8_t>(code);
    memory_.means[3 * count_ + i] = static_cast<std::uint8_t>(code >> 8);
}

void HaarWriter::write(HaarLevels const& levels) {
    memory_.shares[written_] =
        static_cast<std::uint8_t>((levels.shares[0] & 15) | static_cast<std::uint8_t>(levels.shares[1]) << 4);
    for (std::size_t plane = 0; plane < 3; ++plane) {
        put_mean(plane, levels.means[plane]);
        std::int16_t const* const fours = levels.details[plane].data();
        escapes_ = writers_[token_part(plane, false)].write(fours, first_four[0] / 4, escapes_);
        escapes_ = writers_[token_part(plane, true)].write(fours + first_four[0], places(0), escapes_);
    }
    ++written_;
}

std::int16_t HaarReader::mean(std::size_t plane) const {
    std::size_t const i = plane * (means_.size() / mean_bytes) + read_;
    return from_zigzag(static_cast<std::uint16_t>(means_[i] | means_[means_.size() / 2 + i] << 8));
}

DisplayValues HaarReader::read(std::uint8_t quality) {
    std::array<Fours, 3> details{};
    std::array<std::int16_t, 3> means;
    for (std::size_t plane = 0; plane < 3; ++plane) {
        std::uint16_t const base = base_step(plane, quality);
        std::int16_t* const fours = details[plane].data();
        readers_[token_part(plane, false)].read(fours, first_four[0] / 4, escapes_);
        readers_[token_part(plane, true)].read(fours + first_four[0], places(0), escapes_);
        dequantise(details[plane], base);
        means[plane] = times(mean(plane), base);
    }
    unsigned const shares = shares_[read_];
    ++read_;
    auto const share = [](unsigned nibble) { return static_cast<std::int8_t>(nibble < 8 ? nibble : nibble - 16); };
    return synthesise(details, means, {share(shares & 15), share(shares >> 4)});
}

bool HaarReader::is_at_end() const {
    return escapes_.left() == 0 && std::ranges::all_of(readers_, [](TokenReader const& r) { return r.is_at_end(); });
}

} // namespace framelet
