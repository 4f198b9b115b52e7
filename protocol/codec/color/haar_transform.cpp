#include "protocol/codec/color/haar_transform.h"

#include <cstring>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#pragma GCC diagnostic ignored "-Wpsabi" // how processors without AVX would pass these matters to no other file

namespace framelet {
namespace {

/// Four places side by side, and their means. Twice as many have nothing to gain: the coarse octaves have four and one.
using Places [[gnu::vector_size(32)]] = std::uint16_t;
using SignedPlaces [[gnu::vector_size(32)]] = std::int16_t;
using Means [[gnu::vector_size(8)]] = std::uint16_t;
using Words [[gnu::vector_size(32)]] = std::uint64_t; ///< a place each

constexpr std::size_t at_a_time = 4;

constexpr std::uint16_t all = 0xffff;
constexpr Places not_mean{0, all, all, all, 0, all, all, all, 0, all, all, all, 0, all, all, all};

template <std::size_t count>
Places load(std::int16_t const* fours) {
    Places places{};
    std::memcpy(&places, fours, 4 * count * sizeof *fours);
    return places;
}

template <std::size_t count>
void store(Places const& places, std::int16_t* fours) {
    std::memcpy(fours, &places, 4 * count * sizeof *fours);
}

/// -x where the mask is set, x elsewhere.
Places negate(Places const& x, Places const& mask) {
    return (x ^ mask) - mask;
}

/// [a+b+c+d, a-b+c-d, a+b-c-d, a-b-c+d] of each place; twice that gives four times what there was.
Places hadamard(Places const& x) {
    constexpr Places every_second{0, all, 0, all, 0, all, 0, all, 0, all, 0, all, 0, all, 0, all};
    constexpr Places upper_two{0, 0, all, all, 0, 0, all, all, 0, 0, all, all, 0, 0, all, all};
    Places const sums =
        __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14) + negate(x, every_second);
    return __builtin_shufflevector(sums, sums, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13) +
           negate(sums, upper_two);
}

Places forward(Places const& children) {
    Places const sums = hadamard(children) + 2;
    return reinterpret_cast<Places>(reinterpret_cast<SignedPlaces>(sums) >> 2);
}

Means means_of(Places const& places) {
    return __builtin_shufflevector(places, places, 0, 4, 8, 12);
}

/// `means` has four, one after the other.
Places inverse(std::uint64_t means, Places const& details) {
    constexpr Places none{};
    auto const everywhere = reinterpret_cast<Places>(means - Words{});
    // Each half of the register has them all: what moves stays in its half.
    Places const spread =
        __builtin_shufflevector(everywhere, none, 0, 16, 16, 16, 1, 16, 16, 16, 10, 16, 16, 16, 11, 16, 16, 16);
    return hadamard(spread | (details & not_mean));
}

/// The upper halves of 32-bit products.
Places high_products(Places const& a, std::uint16_t b) {
#ifdef __AVX2__
    return reinterpret_cast<Places>(
        _mm256_mulhi_epu16(reinterpret_cast<__m256i>(a), reinterpret_cast<__m256i>(Places{} + b)));
#else
    using Products [[gnu::vector_size(2 * sizeof a)]] = std::uint32_t;
    return __builtin_convertvector(__builtin_convertvector(a, Products) * std::uint32_t{b} >> 16, Places);
#endif
}

/// Quantises, and adds up what the levels take.
class Quantiser {
public:
    explicit Quantiser(DetailStep const& step) : step_(step) {}

    /// Levels of details, nothing for the means between them.
    Places operator()(Places const& details) {
        auto const sign = reinterpret_cast<Places>(reinterpret_cast<SignedPlaces>(details) >> 15);
        Places size = negate(details, sign);
        if (step_.step != 1) { // its reciprocal would not fit 16 bits
            size = high_products(size + step_.rounding, step_.reciprocal);
        }
        size &= not_mean;
        auto const there = reinterpret_cast<Places>(size != 0);
        bits_ += (size < most_bits_of_size ? size : Places{} + most_bits_of_size) + (there & bits_of_any);
        return negate(size, sign);
    }

    int bits() const {
        std::uint64_t fours = 0; // sums of all lanes stay far below 2^16
        auto const words = reinterpret_cast<Words>(bits_);
        for (std::size_t i = 0; i < at_a_time; ++i) {
            fours += words[i];
        }
        return static_cast<int>(fours * 0x0001000100010001u >> 48);
    }

private:
    DetailStep const step_;
    Places bits_{};
};

/// Calls `body.template operator()<count>(i)` for places i .. i + count - 1.
template <typename Body>
[[gnu::always_inline]] inline void for_each_places(std::size_t places, Body const& body) {
    constexpr std::size_t one = 1;
    std::size_t i = 0;
    for (; i + at_a_time <= places; i += at_a_time) {
        body.template operator()<at_a_time>(i);
    }
    for (; i < places; ++i) {
        body.template operator()<one>(i);
    }
}

} // namespace

DetailStep::DetailStep(std::uint16_t step_of_levels) : step(step_of_levels) {
    /// Smallest share of a step that rounds up, in 64ths: what is nearer to zero costs more bytes than it removes
    /// error.
    constexpr unsigned share = 22;
    // floor(x / step) of 16-bit x, or one more where x is less than x / 2^16 of a step below a multiple.
    reciprocal = static_cast<std::uint16_t>(65536u / step + 1);
    rounding = static_cast<std::uint16_t>(step * share / 64);
}

int haar_forward(std::int16_t const* fours, std::size_t places, DetailStep const& step, std::int16_t* means,
                 std::int16_t* details, std::int16_t* levels) {
    Quantiser quantiser(step);
    for_each_places(places, [&]<std::size_t count>(std::size_t i) {
        Places const out = forward(load<count>(fours + 4 * i));
        store<count>(out, details + 4 * i);
        store<count>(quantiser(out), levels + 4 * i);
        Means const of_places = means_of(out);
        std::memcpy(means + i, &of_places, count * sizeof *means);
    });
    return quantiser.bits();
}

int quantise(std::int16_t const* details, std::size_t places, DetailStep const& step, std::int16_t* levels) {
    Quantiser quantiser(step);
    for_each_places(places, [&]<std::size_t count>(std::size_t i) {
        store<count>(quantiser(load<count>(details + 4 * i)), levels + 4 * i);
    });
    return quantiser.bits();
}

void haar_inverse(std::int16_t const* means, std::int16_t const* levels, std::uint16_t step, std::size_t places,
                  std::int16_t* out) {
    for_each_places(places, [&]<std::size_t count>(std::size_t i) {
        std::uint64_t of_places = 0;
        std::memcpy(&of_places, means + i, count * sizeof *means);
        store<count>(inverse(of_places, load<count>(levels + 4 * i) * step), out + 4 * i);
    });
}

} // namespace framelet
