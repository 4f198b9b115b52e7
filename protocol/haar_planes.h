// Samples of framelets with loss: quantised Haar details of luma and chroma as tokens, the finest octave apart from the
// rest. In: luma and chroma of framelets, or what is left of them beside a prediction; their quality. Out: parts of
// bytes, and back. PROTOCOL.md has the layout.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "protocol/coefficient_tokens.h"
#include "protocol/display_values.h"

namespace framelet {

/// Of a framelet: means of its three planes; details of its three coarser octaves and of the finest.
inline constexpr std::size_t mean_bytes = 6;
inline constexpr std::size_t coarse_details = 3 * 3 * (1 + 4 + 16);
inline constexpr std::size_t fine_details = 3 * 3 * 64;

/// Quantised details of a framelet's three planes, its octaves from the coarsest, each [0, h, v, d] a place; and the
/// planes' means.
struct HaarLevels {
    static constexpr std::size_t four_values = 4 * (64 + 16 + 4 + 1);
    std::array<std::array<std::int16_t, four_values>, 3> details;
    std::array<std::int16_t, 3> means;
};

/// `quality` is 1..coarsest_quality.
HaarLevels quantise(DisplayValues const& values, std::uint8_t quality);
/// What a reader makes of the levels.
DisplayValues dequantise(HaarLevels const& levels, std::uint8_t quality);
/// Bits that levels will take, roughly: what two ways of coding a framelet are compared by.
int expected_bits(HaarLevels const& levels);

/// Writes `count` framelets, one after the other, into memory that is reused.
class HaarWriter {
public:
    struct Memory {
        std::vector<std::uint8_t> means, coarse, fine, escapes;
    };

    HaarWriter(Memory& memory, std::size_t count);

    void write(HaarLevels const& levels);

    std::span<std::uint8_t const> means() const { return {memory_.means.data(), mean_bytes * count_}; }
    std::span<std::uint8_t const> coarse() const { return coarse_.tokens(); }
    std::span<std::uint8_t const> fine() const { return fine_.tokens(); }
    std::span<std::uint8_t const> escapes() const { return {memory_.escapes.data(), escapes_}; }

private:
    void put_mean(std::size_t plane, std::int16_t level);

    Memory& memory_;
    std::size_t count_;
    std::size_t written_ = 0;
    TokenWriter coarse_, fine_;
    std::uint8_t* escapes_;
};

/// Reads what a HaarWriter wrote. `means` has `mean_bytes` for each framelet.
class HaarReader {
public:
    HaarReader(std::span<std::uint8_t const> means, std::span<std::uint8_t const> escapes,
               std::span<std::uint8_t const> coarse, std::span<std::uint8_t const> fine)
        : means_(means), coarse_(coarse), fine_(fine), escapes_{escapes.data(), escapes.data() + escapes.size()} {}

    /// The next framelet. ProtocolError where escapes are missing.
    DisplayValues read(std::uint8_t quality);

    /// True when nothing is left over.
    bool is_at_end() const { return coarse_.is_at_end() && fine_.is_at_end() && escapes_.left() == 0; }

private:
    std::int16_t mean(std::size_t plane) const;

    std::span<std::uint8_t const> means_;
    TokenReader coarse_, fine_;
    ByteCursor escapes_;
    std::size_t read_ = 0;
};

} // namespace framelet
