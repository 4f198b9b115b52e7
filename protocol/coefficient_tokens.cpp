#include "protocol/coefficient_tokens.h"

#include <cstdlib>
#include <cstring>

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

unsigned take_escape(ByteCursor& escapes) {
    unsigned const code = escapes.take(1)[0];
    if (code == long_escape) {
        auto const bits = escapes.take(2);
        return bits[0] | unsigned{bits[1]} << 8;
    }
    unsigned const size = largest_token_level + 1 + code / 2;
    return code % 2 == 0 ? size : 0u - size;
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

std::uint8_t* TokenWriter::write(std::int16_t const* fours, std::size_t places, std::uint8_t* escapes) {
    for (std::size_t place = 0; place < places; ++place) {
        std::uint64_t word;
        std::memcpy(&word, fours + 4 * place, sizeof word);
        if (word == 0) {
            run_ += 3;
            continue;
        }
        for (std::size_t i = 4 * place + 1; i < 4 * place + 4; ++i) {
            if (fours[i] == 0) {
                ++run_;
            } else {
                escapes = put(fours[i], escapes);
            }
        }
    }
    return escapes;
}

void TokenReader::read(std::int16_t* fours, std::size_t places, std::uint16_t step, ByteCursor& escapes) {
    auto const count = static_cast<std::ptrdiff_t>(3 * places);
    std::ptrdiff_t at = at_;
    std::uint8_t const* next = tokens_.next;
    while (at < count && next != tokens_.end) {
        unsigned const token = *next;
        unsigned const zeros = token >> 4, code = token & 15;
        if (zeros == zeros_alone) {
            at += static_cast<std::ptrdiff_t>(zeros_alone) << code;
            ++next;
            continue;
        }
        if (at + zeros >= count) {
            break; // its level belongs to a later piece
        }
        at += zeros;
        ++next;
        unsigned level = code % 2 == 0 ? code / 2 : 0u - (code + 1) / 2;
        if (code == escape) {
            level = take_escape(escapes);
        }
        // Three details a place, four values.
        fours[at + at / 3 + 1] = static_cast<std::int16_t>(static_cast<std::uint16_t>(level * step));
        ++at;
    }
    tokens_.next = next;
    at_ = at - count;
}

} // namespace framelet
