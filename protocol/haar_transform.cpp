#include "protocol/haar_transform.h"

#include <cstring>

namespace framelet {
namespace {

/// Two places side by side, and the means of four.
using Pair [[gnu::vector_size(16)]] = std::uint16_t;
using SignedPair [[gnu::vector_size(16)]] = std::int16_t;
using Means [[gnu::vector_size(8)]] = std::uint16_t;

constexpr Pair every_second{0, 0xffff, 0, 0xffff, 0, 0xffff, 0, 0xffff};
constexpr Pair upper_two{0, 0, 0xffff, 0xffff, 0, 0, 0xffff, 0xffff};

/// -x where the mask is set, x elsewhere.
Pair negate(Pair x, Pair mask) {
    return (x ^ mask) - mask;
}

/// [a+b+c+d, a-b+c-d, a+b-c-d, a-b-c+d] of each place; twice that gives four times what there was.
Pair hadamard(Pair x) {
    x = __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6) + negate(x, every_second);
    return __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5) + negate(x, upper_two);
}

Pair load(std::int16_t const* from) {
    Pair x;
    std::memcpy(&x, from, sizeof x);
    return x;
}

Pair forward(Pair children) {
    Pair const sums = hadamard(children) + 2;
    return reinterpret_cast<Pair>(reinterpret_cast<SignedPair>(sums) >> 2);
}

Pair inverse(Pair spread_means, Pair details) {
    constexpr Pair not_mean{0, 0xffff, 0xffff, 0xffff, 0, 0xffff, 0xffff, 0xffff};
    return hadamard(spread_means | (details & not_mean));
}

} // namespace

void haar_forward(std::int16_t* fours, std::int16_t* means, std::size_t places) {
    for (; places >= 4; places -= 4) {
        Pair const first = forward(load(fours));
        Pair const second = forward(load(fours + 8));
        std::memcpy(fours, &first, sizeof first);
        std::memcpy(fours + 8, &second, sizeof second);
        Means const mean = __builtin_shufflevector(first, second, 0, 4, 8, 12);
        std::memcpy(means, &mean, sizeof mean);
        fours += 16;
        means += 4;
    }
    for (; places > 0; --places) {
        Pair children{};
        std::memcpy(&children, fours, 4 * sizeof *fours);
        Pair const out = forward(children);
        std::memcpy(fours, &out, 4 * sizeof *fours);
        *means++ = *fours;
        fours += 4;
    }
}

void haar_inverse(std::int16_t const* means, std::int16_t* fours, std::size_t places) {
    constexpr Means none{};
    for (; places >= 4; places -= 4) {
        Means mean;
        std::memcpy(&mean, means, sizeof mean);
        Pair const first = inverse(__builtin_shufflevector(mean, none, 0, 4, 4, 4, 1, 4, 4, 4), load(fours));
        Pair const second = inverse(__builtin_shufflevector(mean, none, 2, 4, 4, 4, 3, 4, 4, 4), load(fours + 8));
        std::memcpy(fours, &first, sizeof first);
        std::memcpy(fours + 8, &second, sizeof second);
        fours += 16;
        means += 4;
    }
    for (; places > 0; --places) {
        Pair details{}, mean{};
        std::memcpy(&details, fours, 4 * sizeof *fours);
        std::memcpy(&mean, means, sizeof *means);
        Pair const children = inverse(mean, details);
        std::memcpy(fours, &children, 4 * sizeof *fours);
        fours += 4;
        ++means;
    }
}

} // namespace framelet
