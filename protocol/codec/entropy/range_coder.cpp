#include "protocol/codec/entropy/range_coder.h"

namespace framelet {

void RangeWriter::put_byte() {
    constexpr std::uint64_t all = 0xffffffff;
    constexpr std::uint64_t last_byte = 0xff000000;
    if (low_ < last_byte || low_ > all) { // whether there is a carry is settled
        auto const carry = static_cast<std::uint8_t>(low_ >> 32);
        if (!is_first_) {
            bytes_.push_back(static_cast<std::uint8_t>(held_ + carry));
        }
        is_first_ = false;
        bytes_.insert(bytes_.end(), full_, static_cast<std::uint8_t>(0xff + carry));
        full_ = 0;
        held_ = static_cast<std::uint8_t>(low_ >> 24);
    } else {
        ++full_;
    }
    low_ = low_ << 8 & all;
}

std::span<std::uint8_t const> RangeWriter::finish() {
    // Takes that of the numbers in the range which ends with the most zeros.
    std::uint64_t const first = low_, last = low_ + range_ - 1;
    for (int zeros = 32; zeros >= 0; --zeros) {
        std::uint64_t const mask = (std::uint64_t{1} << zeros) - 1;
        std::uint64_t const number = (first + mask) & ~mask;
        if (number <= last) {
            low_ = number;
            break;
        }
    }
    for (int i = 0; i < 5; ++i) {
        put_byte();
    }
    while (!bytes_.empty() && bytes_.back() == 0) {
        bytes_.pop_back();
    }
    return bytes_;
}

} // namespace framelet
