// Quantised details of the Haar transform as bytes: most are zero, so a byte says how many zeros and which level comes
// after them. In: fours as of haar_transform. Out: tokens and escapes, and back. PROTOCOL.md has the table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/codec/entropy/byte_cursor.h"

namespace framelet {

/// Largest level that a token holds itself; greater ones are escapes: of one byte, or three.
inline constexpr int largest_token_level = 7;
/// Bounds for `details` of them that were written.
constexpr std::size_t most_token_bytes(std::size_t details) {
    return details;
}
constexpr std::size_t most_escape_bytes(std::size_t details) {
    return 3 * details;
}

/// Writes one sequence in as many calls as there are pieces. Zeros at its end are not written.
class TokenWriter {
public:
    /// `tokens` has room for `most_token_bytes` of all that will be written.
    explicit TokenWriter(std::uint8_t* tokens) : begin_(tokens), next_(tokens) {}

    /// Details of each place, [0, h, v, d]. `escapes` has room for `most_escape_bytes`; returns where it ends.
    std::uint8_t* write(std::int16_t const* fours, std::size_t places, std::uint8_t* escapes);

    std::span<std::uint8_t const> tokens() const { return {begin_, next_}; }

private:
    std::uint8_t* put(std::int16_t level, std::uint8_t* escapes);

    std::uint8_t* begin_;
    std::uint8_t* next_;
    std::size_t run_ = 0;
};

class TokenReader {
public:
    explicit TokenReader(std::span<std::uint8_t const> tokens)
        : tokens_{tokens.data(), tokens.data() + tokens.size()} {}

    /// Writes the levels that the sequence has for at most 64 places; the rest of `fours` must be zero. ProtocolError
    /// where `escapes` is too short.
    void read(std::int16_t* fours, std::size_t places, ByteCursor& escapes);

    bool is_at_end() const { return tokens_.next == tokens_.end; }

private:
    ByteCursor tokens_;
    std::ptrdiff_t at_ = 0; ///< the next detail of the sequence that no token has covered yet, in this piece's details
};

} // namespace framelet
