#include "protocol/codec/color/haar_transform.h"

#include <cstring>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#pragma GCC diagnostic ignored "-Wpsabi" // how processors without AVX would pass these matters to no other file

namespace framelet {
namespace {

/// Four blocks side by side, and their means. Twice as many have nothing to gain: the coarse octaves have four and one.
using Blocks [[gnu::vector_size(32)]] = std::uint16_t;
using SignedBlocks [[gnu::vector_size(32)]] = std::int16_t;
using Means [[gnu::vector_size(8)]] = std::uint16_t;
using Words [[gnu::vector_size(32)]] = std::uint64_t; ///< a block each

constexpr std::size_t at_a_time = 4;

constexpr std::uint16_t all = 0xffff;
constexpr Blocks not_mean{0, all, all, all, 0, all, all, all, 0, all, all, all, 0, all, all, all};

template <std::size_t count>
Blocks load(std::int16_t const* values) {
    Blocks blocks{};
    std::memcpy(&blocks, values, 4 * count * sizeof *values);
    return blocks;
}

template <std::size_t count>
void store(Blocks const& blocks, std::int16_t* values) {
    std::memcpy(values, &blocks, 4 * count * sizeof *values);
}

/// -x where the mask is set, x elsewhere.
Blocks negate(Blocks const& x, Blocks const& mask) {
    return (x ^ mask) - mask;
}

/// Sums [a+b+c+d, a-b+c-d, a+b-c-d, a-b-c+d] of each block; applied twice it gives four times what there was.
Blocks hadamard(Blocks const& x) {
    constexpr Blocks every_second{0, all, 0, all, 0, all, 0, all, 0, all, 0, all, 0, all, 0, all};
    constexpr Blocks upper_two{0, 0, all, all, 0, 0, all, all, 0, 0, all, all, 0, 0, all, all};
    Blocks const sums =
        __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14) + negate(x, every_second);
    return __builtin_shufflevector(sums, sums, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13) +
           negate(sums, upper_two);
}

Blocks forward(Blocks const& children) {
    Blocks const sums = hadamard(children) + 2;
    return reinterpret_cast<Blocks>(reinterpret_cast<SignedBlocks>(sums) >> 2);
}

Means means_of(Blocks const& blocks) {
    return __builtin_shufflevector(blocks, blocks, 0, 4, 8, 12);
}

/// Children of four blocks from their details and their means, which `means` has one after the other.
Blocks inverse(std::uint64_t means, Blocks const& details) {
    constexpr Blocks none{};
    auto const everywhere = reinterpret_cast<Blocks>(means - Words{});
    // Each half of the register has all four means, so that the shuffle moves nothing across halves.
    Blocks const spread =
        __builtin_shufflevector(everywhere, none, 0, 16, 16, 16, 1, 16, 16, 16, 10, 16, 16, 16, 11, 16, 16, 16);
    return hadamard(spread | (details & not_mean));
}

/// Upper halves of the 32-bit products of `a` and `b`.
Blocks high_products(Blocks const& a, std::uint16_t b) {
#ifdef __AVX2__
    return reinterpret_cast<Blocks>(
        _mm256_mulhi_epu16(reinterpret_cast<__m256i>(a), reinterpret_cast<__m256i>(Blocks{} + b)));
#else
    using Products [[gnu::vector_size(2 * sizeof a)]] = std::uint32_t;
    return __builtin_convertvector(__builtin_convertvector(a, Products) * std::uint32_t{b} >> 16, Blocks);
#endif
}

/// Quantises details, and adds up the bits that their levels take, roughly.
class Quantiser {
public:
    explicit Quantiser(DetailStep const& step) : step_(step) {}

    /// Levels of the details, 0 for the means between them.
    Blocks operator()(Blocks const& details) {
        auto const sign = reinterpret_cast<Blocks>(reinterpret_cast<SignedBlocks>(details) >> 15);
        Blocks size = negate(details, sign);
        if (step_.step != 1) { // its reciprocal would not fit 16 bits
            size = high_products(size + step_.rounding, step_.reciprocal);
        }
        size &= not_mean;
        auto const there = reinterpret_cast<Blocks>(size != 0);
        bits_ += (size < most_bits_of_size ? size : Blocks{} + most_bits_of_size) + (there & bits_of_any);
        return negate(size, sign);
    }

    int bits() const {
        std::uint64_t sums = 0; // those of all lanes stay far below 2^16
        auto const words = reinterpret_cast<Words>(bits_);
        for (std::size_t i = 0; i < at_a_time; ++i) {
            sums += words[i];
        }
        return static_cast<int>(sums * 0x0001000100010001u >> 48);
    }

private:
    DetailStep const step_;
    Blocks bits_{};
};

/// Calls `body.template operator()<count>(i)` for blocks i .. i + count - 1.
template <typename Body>
[[gnu::always_inline]] inline void for_each_blocks(std::size_t blocks, Body const& body) {
    constexpr std::size_t one = 1;
    std::size_t i = 0;
    for (; i + at_a_time <= blocks; i += at_a_time) {
        body.template operator()<at_a_time>(i);
    }
    for (; i < blocks; ++i) {
        body.template operator()<one>(i);
    }
}

} // namespace

DetailStep::DetailStep(std::uint16_t step_of_levels) : step(step_of_levels) {
    // A size is rounded up where at most this share of a step, in 64ths, is missing to the next level: what is nearer
    // to zero costs more bytes than it removes error.
    constexpr unsigned share = 22;
    // The upper half of x times this is floor(x / step) for 16-bit x, or one more where x is less than x / 2^16 of a
    // step below a multiple.
    reciprocal = static_cast<std::uint16_t>(65536u / step + 1);
    rounding = static_cast<std::uint16_t>(step * share / 64);
}

int haar_forward(std::int16_t const* children, std::size_t blocks, DetailStep const& step, std::int16_t* means,
                 std::int16_t* details, std::int16_t* levels) {
    Quantiser quantiser(step);
    for_each_blocks(blocks, [&]<std::size_t count>(std::size_t i) {
        Blocks const out = forward(load<count>(children + 4 * i));
        store<count>(out, details + 4 * i);
        store<count>(quantiser(out), levels + 4 * i);
        Means const of_blocks = means_of(out);
        std::memcpy(means + i, &of_blocks, count * sizeof *means);
    });
    return quantiser.bits();
}

int quantise(std::int16_t const* details, std::size_t blocks, DetailStep const& step, std::int16_t* levels) {
    Quantiser quantiser(step);
    for_each_blocks(blocks, [&]<std::size_t count>(std::size_t i) {
        store<count>(quantiser(load<count>(details + 4 * i)), levels + 4 * i);
    });
    return quantiser.bits();
}

void haar_inverse(std::int16_t const* means, std::int16_t const* levels, std::uint16_t step, std::size_t blocks,
                  std::int16_t* out) {
    for_each_blocks(blocks, [&]<std::size_t count>(std::size_t i) {
        std::uint64_t of_blocks = 0;
        std::memcpy(&of_blocks, means + i, count * sizeof *means);
        store<count>(inverse(of_blocks, load<count>(levels + 4 * i) * step), out + 4 * i);
    });
}

} // namespace framelet
