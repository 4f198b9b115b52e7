#include "protocol/haar_transform.h"

#include <cstring>

#pragma GCC diagnostic ignored "-Wpsabi" // how processors without AVX would pass these matters to no other file

namespace framelet {
namespace {

/// Four places side by side, and their means.
using Places [[gnu::vector_size(32)]] = std::uint16_t;
using SignedPlaces [[gnu::vector_size(32)]] = std::int16_t;
using Means [[gnu::vector_size(8)]] = std::uint16_t;
using Words [[gnu::vector_size(32)]] = std::uint64_t; ///< a place each

constexpr std::size_t at_a_time = 4;

Places one_place(std::int16_t const* four) {
    std::uint64_t word;
    std::memcpy(&word, four, sizeof word);
    return reinterpret_cast<Places>(Words{word});
}

/// -x where the mask is set, x elsewhere.
Places negate(Places const& x, Places const& mask) {
    return (x ^ mask) - mask;
}

/// [a+b+c+d, a-b+c-d, a+b-c-d, a-b-c+d] of each place; twice that gives four times what there was.
Places hadamard(Places const& x) {
    constexpr std::uint16_t all = 0xffff;
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
    constexpr std::uint16_t all = 0xffff;
    constexpr Places not_mean{0, all, all, all, 0, all, all, all, 0, all, all, all, 0, all, all, all}, none{};
    auto const everywhere = reinterpret_cast<Places>(means - Words{});
    // Each half of the register has them all: what moves stays in its half.
    Places const spread =
        __builtin_shufflevector(everywhere, none, 0, 16, 16, 16, 1, 16, 16, 16, 10, 16, 16, 16, 11, 16, 16, 16);
    return hadamard(spread | (details & not_mean));
}

} // namespace

void haar_forward(std::int16_t* fours, std::int16_t* means, std::size_t places) {
    for (; places >= at_a_time; places -= at_a_time) {
        Places children;
        std::memcpy(&children, fours, sizeof children);
        Places const out = forward(children);
        Means const mean = means_of(out);
        std::memcpy(fours, &out, sizeof out);
        std::memcpy(means, &mean, sizeof mean);
        fours += 4 * at_a_time;
        means += at_a_time;
    }
    for (; places > 0; --places) {
        Places const out = forward(one_place(fours));
        std::memcpy(fours, &out, 4 * sizeof *fours);
        *means++ = *fours;
        fours += 4;
    }
}

void haar_inverse(std::int16_t const* means, std::int16_t const* fours, std::size_t places, std::int16_t* out) {
    for (; places >= at_a_time; places -= at_a_time) {
        std::uint64_t four_means;
        Places details;
        std::memcpy(&four_means, means, sizeof four_means);
        std::memcpy(&details, fours, sizeof details);
        Places const children = inverse(four_means, details);
        std::memcpy(out, &children, sizeof children);
        fours += 4 * at_a_time;
        out += 4 * at_a_time;
        means += at_a_time;
    }
    for (; places > 0; --places) {
        Places const children = inverse(static_cast<std::uint16_t>(*means++), one_place(fours));
        std::memcpy(out, &children, 4 * sizeof *fours);
        fours += 4;
        out += 4;
    }
}

} // namespace framelet
