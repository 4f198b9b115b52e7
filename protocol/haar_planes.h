// Samples of framelets with loss: quantised Haar details of luma and chroma as tokens, the finest octave apart from the
// rest. In: framelets, their quality. Out: parts of bytes, and back. PROTOCOL.md has the layout.
#pragma once

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

/// Writes `count` framelets, one after the other, into memory that is reused.
class HaarWriter {
public:
    struct Memory {
        std::vector<std::uint8_t> means, coarse, fine, escapes;
    };

    HaarWriter(Memory& memory, std::size_t count);

    /// `quality` is 1..coarsest_quality.
    void write(DisplayFramelet const& framelet, std::uint8_t quality);

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

    /// The next framelet; its tile stays. ProtocolError where escapes are missing.
    void read(DisplayFramelet& framelet, std::uint8_t quality);

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
