#include "protocol/codec/entropy/coefficient_tokens.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "common/error.h"

namespace framelet {
namespace {

/// High half of a token: zeros before the level; the last value says that the token is of zeros alone, this many
/// shifted left by the low half.
constexpr std::size_t zeros_alone = 15;
/// Low half: 2 |level| - 1 where it is negative, 2 |level| where it is positive.
constexpr unsigned escape = 0;
/// What an escape of one byte states beside this: 2 (|level| - 8), and 1 more where the level is negative.
constexpr unsigned long_escape = 255;

std::uint8_t* put_escape(std::int16_t level, std::uint8_t* escapes) {
    auto const code = static_cast<unsigned>(2 * (std::abs(int{level}) - largest_token_level - 1) + (level < 0 ? 1 : 0));
    if (code < long_escape) {
        *escapes++ = static_cast<std::uint8_t>(code);
        return escapes;
    }
    auto const bits = static_cast<std::uint16_t>(level);
    *escapes++ = long_escape;
    *escapes++ = static_cast<std::uint8_t>(bits);
    *escapes++ = static_cast<std::uint8_t>(bits >> 8);
    return escapes;
}

std::int16_t take_escape(ByteCursor& escapes) {
    unsigned const code = escapes.take(1)[0];
    if (code == long_escape) {
        auto const bits = escapes.take(2);
        return static_cast<std::int16_t>(bits[0] | unsigned{bits[1]} << 8);
    }
    int const size = largest_token_level + 1 + static_cast<int>(code / 2);
    return static_cast<std::int16_t>(code % 2 == 0 ? size : -size);
}

} // namespace

std::uint8_t* TokenWriter::put(std::int16_t level, std::uint8_t* escapes) {
    while (run_ >= zeros_alone) {
        unsigned shift = 0;
        while (shift < 15 && zeros_alone << (shift + 1) <= run_) {
            ++shift;
        }
        *next_++ = static_cast<std::uint8_t>(zeros_alone << 4 | shift);
        run_ -= zeros_alone << shift;
    }
    int const size = std::abs(int{level});
    unsigned code = escape;
    if (size <= largest_token_level) {
        code = static_cast<unsigned>(2 * size - (level < 0 ? 1 : 0));
    } else {
        escapes = put_escape(level, escapes);
    }
    *next_++ = static_cast<std::uint8_t>(run_ << 4 | code);
    run_ = 0;
    return escapes;
}

namespace {

/// Places whose values have a bit each.
constexpr std::size_t mask_places = 16;

/// Bit i: value i is not zero.
std::uint64_t levels_of(std::int16_t const* fours) {
    std::uint64_t mask = 0;
#ifdef __SSE2__
    constexpr std::size_t half = 8, bits = 16;
    auto const load = [](std::int16_t const* from) { return _mm_loadu_si128(reinterpret_cast<__m128i const*>(from)); };
    for (std::size_t i = 0; i < 4 * mask_places; i += bits) {
        __m128i const bytes = _mm_packs_epi16(load(fours + i), load(fours + i + half));
        auto const zeros = static_cast<unsigned>(_mm_movemask_epi8(_mm_cmpeq_epi8(bytes, _mm_setzero_si128())));
        mask |= std::uint64_t{zeros ^ 0xffff} << i;
    }
#else
    for (std::size_t i = 0; i < 4 * mask_places; ++i) {
        mask |= std::uint64_t{fours[i] != 0} << i;
    }
#endif
    return mask;
}

} // namespace

std::uint8_t* TokenWriter::write(std::int16_t const* fours, std::size_t places, std::uint8_t* escapes) {
    for (std::size_t first = 0; first < places; first += mask_places) {
        std::size_t const some = std::min(mask_places, places - first);
        std::int16_t const* values = fours + 4 * first;
        std::array<std::int16_t, 4 * mask_places> rest;
        if (some < mask_places) {
            rest = {};
            std::copy_n(values, 4 * some, rest.begin());
            values = rest.data();
        }
        std::size_t covered = 0; // details
        for (std::uint64_t left = levels_of(values); left != 0; left &= left - 1) {
            auto const i = static_cast<std::size_t>(std::countr_zero(left));
            std::size_t const detail = i - i / 4 - 1;
            run_ += detail - covered;
            covered = detail + 1;
            escapes = put(values[i], escapes);
        }
        run_ += 3 * some - covered;
    }
    return escapes;
}

namespace {

/// Of a piece.
constexpr std::size_t most_details = 3 * 64;

/// Where the details of a sequence are among fours: three a place.
constexpr auto make_places_of_details() {
    std::array<std::uint8_t, most_details> places{};
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i] = static_cast<std::uint8_t>(i + i / 3 + 1);
    }
    return places;
}
constexpr auto places_of_details = make_places_of_details();

/// What each token says: how far its level, or what comes after its zeros, is from where it begins; the level.
struct Meaning {
    std::int32_t zeros;
    std::int16_t level; ///< 0: none here
};
constexpr auto make_meanings() {
    std::array<Meaning, 256> meanings{};
    for (unsigned token = 0; token < meanings.size(); ++token) {
        unsigned const zeros = token >> 4, code = token & 15;
        bool const is_alone = zeros == zeros_alone;
        int const size = static_cast<int>((code + 1) / 2);
        meanings[token] = {static_cast<std::int32_t>(is_alone ? zeros << code : zeros),
                           static_cast<std::int16_t>(is_alone        ? 0
                                                     : code % 2 == 0 ? size
                                                                     : -size)};
    }
    return meanings;
}
constexpr auto meanings = make_meanings();
static_assert(meanings[escape].level == 0);

} // namespace

void TokenReader::read(std::int16_t* fours, std::size_t places, ByteCursor& escapes) {
    FRAMELET_CHECK(3 * places <= most_details);
    auto const count = static_cast<std::ptrdiff_t>(3 * places);
    std::ptrdiff_t at = at_;
    std::uint8_t const* next = tokens_.next;
    while (at < count && next != tokens_.end) {
        unsigned const token = *next;
        Meaning const meaning = meanings[token];
        std::ptrdiff_t const to = at + meaning.zeros;
        std::int16_t level = meaning.level;
        if (level == 0) { // zeros alone, or an escape
            if (token >> 4 == zeros_alone) {
                at = to;
                ++next;
                continue;
            }
            if (to < count) {
                level = take_escape(escapes);
            }
        }
        if (to >= count) {
            break; // its level belongs to a later piece
        }
        fours[places_of_details[static_cast<std::size_t>(to)]] = level;
        at = to + 1;
        ++next;
    }
    tokens_.next = next;
    at_ = at - count;
}

} // namespace framelet
