// Samples of framelets with loss: quantised Haar details of luma and chroma as tokens, the finest octave apart from the
// rest, chroma beside a share of luma. In: luma and chroma of framelets, or what is left of them beside a prediction;
// their quality. Out: parts of bytes, and back. PROTOCOL.md has the layout.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "protocol/codec/color/display_values.h"
#include "protocol/codec/entropy/coefficient_tokens.h"

namespace framelet {

/// Of a framelet: means of its three planes, shares of luma; details of a plane's three coarser octaves and of the
/// finest.
inline constexpr std::size_t mean_bytes = 6, share_bytes = 1;
inline constexpr std::size_t coarse_details = 3 * (1 + 4 + 16);
inline constexpr std::size_t fine_details = 3 * 64;

/// Of one plane, its octaves from the coarsest, each [mean, h, v, d] a place.
using Fours = std::array<std::int16_t, 4 * (64 + 16 + 4 + 1)>;

/// Details of a framelet's three planes and the planes' means, quantised; 0 instead of the means of places.
struct HaarLevels {
    std::array<Fours, 3> details;
    std::array<std::int16_t, 3> means;
    /// Eighths of luma's details that those of Co and of Cg have besides, -8..7.
    std::array<std::int8_t, 2> shares;
};

/// A way of coding a framelet, and the details that it was made of, sixteenths.
struct HaarCode {
    std::array<Fours, 3> values;
    HaarLevels levels;
    std::array<int, 3> bits; ///< that each plane's details will take, roughly, before luma is shared
};

/// Returns the bits that the levels will take, roughly: what ways of coding a framelet are compared by. Above `most` it
/// gives up, and the levels are not to be used. `quality` is 1..coarsest_quality.
int code(DisplayValues const& values, std::uint8_t quality, int most, HaarCode& out);
/// Quantises chroma again, beside a share of luma, where that takes less.
void share_luma(std::uint8_t quality, HaarCode& code);
/// What a reader makes of the levels.
DisplayValues dequantise(HaarLevels const& levels, std::uint8_t quality);

/// Token parts: luma and chroma of the coarser octaves, of the finest.
inline constexpr std::size_t token_parts = 4;
constexpr std::size_t token_part(std::size_t plane, bool is_finest) {
    return (plane == 0 ? 0 : 1) + (is_finest ? 2 : 0);
}
/// Most bytes of tokens and escapes of a framelet.
inline constexpr std::size_t most_detail_bytes =
    most_token_bytes(3 * (coarse_details + fine_details)) + most_escape_bytes(3 * (coarse_details + fine_details));

/// Writes `count` framelets, one after the other, into memory that is reused.
class HaarWriter {
public:
    struct Memory {
        std::vector<std::uint8_t> shares, means, escapes;
        std::array<std::vector<std::uint8_t>, token_parts> tokens;
    };

    HaarWriter(Memory& memory, std::size_t count);

    void write(HaarLevels const& levels);

    std::span<std::uint8_t const> shares() const { return {memory_.shares.data(), share_bytes * count_}; }
    std::span<std::uint8_t const> means() const { return {memory_.means.data(), mean_bytes * count_}; }
    std::span<std::uint8_t const> tokens(std::size_t part) const { return writers_[part].tokens(); }
    std::span<std::uint8_t const> escapes() const { return {memory_.escapes.data(), escapes_}; }

private:
    void put_mean(std::size_t plane, std::int16_t level);

    Memory& memory_;
    std::size_t count_;
    std::size_t written_ = 0;
    std::array<TokenWriter, token_parts> writers_;
    std::uint8_t* escapes_;
};

/// Reads what a HaarWriter wrote. `shares` and `means` have `share_bytes` and `mean_bytes` for each framelet.
class HaarReader {
public:
    using Parts = std::array<std::span<std::uint8_t const>, token_parts>;

    HaarReader(std::span<std::uint8_t const> shares, std::span<std::uint8_t const> means,
               std::span<std::uint8_t const> escapes, Parts const& tokens)
        : shares_(shares), means_(means), readers_{TokenReader(tokens[0]), TokenReader(tokens[1]),
                                                   TokenReader(tokens[2]), TokenReader(tokens[3])},
          escapes_{escapes.data(), escapes.data() + escapes.size()} {}

    /// The next framelet. ProtocolError where escapes are missing.
    DisplayValues read(std::uint8_t quality);

    /// True when nothing is left over.
    bool is_at_end() const;

private:
    std::int16_t mean(std::size_t plane) const;

    std::span<std::uint8_t const> shares_, means_;
    std::array<TokenReader, token_parts> readers_;
    ByteCursor escapes_;
    std::size_t read_ = 0;
};

} // namespace framelet
