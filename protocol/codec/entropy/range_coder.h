// Range coder: codes binary decisions as bytes and back, each with about as many bits as it is unlikely (range coding
// [Martin 1979]; the carry as in LZMA). In: decisions, and how likely each has been lately. Out: bytes, and back.
// PROTOCOL.md has the arithmetic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace framelet {

/// Chance that a decision is a yes: the mean of what it was lately and of what it was for longer.
class AdaptiveBit {
public:
    /// Chance of a yes as a fraction of 2^16; never 0 and never 2^16.
    std::uint32_t chance() const { return (std::uint32_t{lately_} + longer_) >> 1; }
    void learn(bool yes) {
        lately_ = moved(lately_, yes, lately_shift);
        longer_ = moved(longer_, yes, longer_shift);
    }

private:
    static constexpr int lately_shift = 4, longer_shift = 6;
    static constexpr std::uint16_t half = 1 << 15, most = 0xffff;

    /// The chance after a decision. It stops within 2^shift of either end, where the step is rounded down to 0.
    static std::uint16_t moved(std::uint16_t chance, bool yes, int shift) {
        return static_cast<std::uint16_t>(yes ? chance + ((most - chance) >> shift) : chance - (chance >> shift));
    }

    std::uint16_t lately_ = half, longer_ = half;
};

namespace range_coding {
inline constexpr std::uint32_t even_chance = 1u << 15;
inline constexpr int chance_bits = 16;
/// The least range with which a decision is coded: while it is smaller, a byte is moved and the range grows by 8 bits.
inline constexpr std::uint32_t least_range = 1u << 24;
} // namespace range_coding

/// Writes decisions. What it has written is complete after `finish`.
class RangeWriter {
public:
    /// Writes a decision and returns it, as the reader does: what codes a value both ways is written once, for either.
    bool bit(AdaptiveBit& chance, bool yes) {
        put(yes, chance.chance());
        chance.learn(yes);
        return yes;
    }
    /// Writes a decision that is as likely a yes as a no, and returns it.
    bool even_bit(bool yes) {
        put(yes, range_coding::even_chance);
        return yes;
    }

    void begin() { *this = RangeWriter(std::move(bytes_)); }
    /// Completes the bytes and returns them, valid until the next `begin`. Zeros at the end are left out.
    std::span<std::uint8_t const> finish();

    static constexpr bool reads = false;

    RangeWriter() = default;

private:
    explicit RangeWriter(std::vector<std::uint8_t>&& room) : bytes_(std::move(room)) { bytes_.clear(); }

    void put(bool yes, std::uint32_t chance) {
        std::uint32_t const bound = (range_ >> range_coding::chance_bits) * chance;
        if (yes) {
            range_ = bound;
        } else {
            low_ += bound;
            range_ -= bound;
        }
        while (range_ < range_coding::least_range) {
            put_byte();
            range_ <<= 8;
        }
    }
    void put_byte();

    std::vector<std::uint8_t> bytes_;
    std::uint64_t low_ = 0; ///< lower end of the range: 32 bits, and a carry
    std::uint32_t range_ = 0xffffffff;
    std::uint8_t held_ = 0; ///< a byte that a carry may yet change
    std::size_t full_ = 0; ///< how many bytes of 255 follow `held_`
    bool is_first_ = true; ///< the byte held is the first one, which is always 0 and not written
};

/// Reads what a RangeWriter wrote; behind the last byte there are zeros, as many as are asked for.
class RangeReader {
public:
    explicit RangeReader(std::span<std::uint8_t const> bytes) : next_(bytes.data()), end_(bytes.data() + bytes.size()) {
        for (int i = 0; i < 4; ++i) {
            code_ = code_ << 8 | take();
        }
    }

    /// Reads a decision; the second argument is ignored.
    bool bit(AdaptiveBit& chance, bool /*yes*/ = false) {
        bool const yes = get(chance.chance());
        chance.learn(yes);
        return yes;
    }
    bool even_bit(bool /*yes*/ = false) { return get(range_coding::even_chance); }

    bool is_at_end() const { return next_ == end_; }

    static constexpr bool reads = true;

private:
    bool get(std::uint32_t chance) {
        std::uint32_t const bound = (range_ >> range_coding::chance_bits) * chance;
        bool const yes = code_ < bound;
        if (yes) {
            range_ = bound;
        } else {
            code_ -= bound;
            range_ -= bound;
        }
        while (range_ < range_coding::least_range) {
            code_ = code_ << 8 | take();
            range_ <<= 8;
        }
        return yes;
    }
    std::uint8_t take() { return next_ == end_ ? std::uint8_t{0} : *next_++; }

    std::uint8_t const* next_;
    std::uint8_t const* end_;
    std::uint32_t code_ = 0;
    std::uint32_t range_ = 0xffffffff;
};

} // namespace framelet
