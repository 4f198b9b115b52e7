#include "protocol/codec/geometry/shape_masks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

#include "common/error.h"
#include "protocol/codec/entropy/morton_rows.h"

namespace framelet {
namespace {

/// What a sample may be: one of the layers, or loose, which is the last kind.
constexpr unsigned kinds_of(std::uint8_t head) {
    return layers_of_head(head) + (head_has_loose(head) ? 1u : 0u);
}

/// A byte of gaps: so many samples are of the kind that is expected, then one is not; or one of these: so many are, and
/// it goes on; all the rest are.
constexpr std::uint8_t goes_on = 254, rest = 255;

/// The kinds of a framelet in raster order, with rows of none above the first one.
class KindRows {
public:
    KindRows() { std::fill_n(kinds_.begin(), margin, no_kind); }

    std::uint8_t* begin() { return kinds_.data() + margin; }
    std::uint8_t operator[](std::size_t at) const { return kinds_[margin + at]; }

    /// What a sample is expected to be: as the one above it, but as that to its left where a horizontal edge lies
    /// between that and what is above it. In the first row that to the left; 0 for the first.
    std::uint8_t expected(std::size_t at) const {
        std::uint8_t const* const kind = kinds_.data() + margin + at;
        if (at % framelet_side == 0) {
            return at == 0 ? std::uint8_t{0} : kind[above];
        }
        return kind[-1] == kind[above - 1] ? kind[above] : kind[-1];
    }

    /// 1 for every sample that is not as expected, else 0.
    SamplePlane others() const {
        SamplePlane others;
        for (std::ptrdiff_t at = 0; at < framelet_samples; ++at) { // many at a time
            std::uint8_t const* const kind = kinds_.data() + margin + at;
            bool const is_above = kind[-1] == kind[above - 1] || at % framelet_side == 0;
            others[static_cast<std::size_t>(at)] = kind[0] != (is_above ? kind[above] : kind[-1]) ? 1 : 0;
        }
        others[0] = kinds_[margin] != 0 ? 1 : 0;
        return others;
    }

private:
    static constexpr std::size_t margin = 2 * framelet_side;
    static constexpr std::ptrdiff_t above = -framelet_side;
    static constexpr std::uint8_t no_kind = 255;
    std::array<std::uint8_t, margin + framelet_samples> kinds_;
};

/// How far the kinds that come otherwise are from what is expected goes to `turns`, unless there are but two.
void put_mask(FrameletShape const& shape, std::vector<std::uint8_t>& gaps, std::vector<std::uint8_t>& turns) {
    unsigned const kinds = kinds_of(shape_head(shape));
    SamplePlane in_order;
    std::transform(shape.layer_of.begin(), shape.layer_of.end(), in_order.begin(),
                   [loose = shape.layer_count](std::uint8_t layer) { return std::min(layer, loose); });
    KindRows rows;
    to_rows(in_order.data(), rows.begin(), framelet_side);
    SamplePlane const others = rows.others();
    std::size_t told = 0;
    auto const tell_until = [&](std::size_t at) {
        for (; at - told >= goes_on; told += goes_on) {
            gaps.push_back(goes_on);
        }
    };
    for (std::size_t eight = 0; eight < framelet_samples; eight += sizeof(std::uint64_t)) {
        std::uint64_t left;
        for (std::memcpy(&left, &others[eight], sizeof left); left != 0; left &= left - 1) {
            std::size_t const at = eight + static_cast<std::size_t>(std::countr_zero(left)) / 8;
            tell_until(at);
            gaps.push_back(static_cast<std::uint8_t>(at - told));
            told = at + 1;
            if (kinds > 2) {
                turns.push_back(static_cast<std::uint8_t>((rows[at] + kinds - rows.expected(at)) % kinds));
            }
        }
    }
    tell_until(framelet_samples);
    if (told < framelet_samples) {
        gaps.push_back(rest);
    }
}

/// The gaps of one framelet, and how many samples they say are not as expected.
struct Gaps {
    std::span<std::uint8_t const> bytes;
    std::size_t others = 0;
};

Gaps take_gaps(ByteCursor& bytes) {
    Gaps gaps;
    std::uint8_t const* const first = bytes.next;
    for (std::size_t covered = 0; covered < framelet_samples;) {
        std::uint8_t const gap = bytes.take(1)[0];
        if (gap == rest) {
            break;
        }
        covered += gap == goes_on ? goes_on : gap + 1u;
        gaps.others += gap == goes_on ? 0 : 1;
        if (covered > framelet_samples) {
            throw ProtocolError("a shape's mask is longer than its samples");
        }
    }
    gaps.bytes = {first, bytes.next};
    return gaps;
}

/// The kinds of a row's samples, two bits each: a bit in each word.
class KindRow {
public:
    unsigned operator[](std::size_t x) const { return (low_ >> x & 1) | (high_ >> x & 1) << 1; }

    /// The sample at x is of a kind that was not expected there. To its right others follow it, as far as to where the
    /// row above has its kind: from there on they are as those. `above`: null for the first row, all of which follows.
    void turn(std::size_t x, unsigned kind, KindRow const* above) {
        Word const right = ~Word{0} << x;
        Word follows = right;
        if (above != nullptr) {
            low_ = (low_ & ~right) | (above->low_ & right);
            high_ = (high_ & ~right) | (above->high_ & right);
            Word const met = ~(above->low_ ^ everywhere(kind & 1)) & ~(above->high_ ^ everywhere(kind >> 1)) & right;
            follows &= (met & (~met + 1)) - 1; // all, if it meets none
        }
        low_ = (low_ & ~follows) | (everywhere(kind & 1) & follows);
        high_ = (high_ & ~follows) | (everywhere(kind >> 1) & follows);
    }

    void write(std::uint8_t* kinds) const {
        Bytes const row = (bytes(low_) & 1) | (bytes(high_) & 2);
        std::memcpy(kinds, &row, sizeof row);
    }

private:
    using Word = std::uint32_t; // its upper half says nothing
    using Bytes [[gnu::vector_size(framelet_side)]] = std::uint8_t;
    using Halves [[gnu::vector_size(framelet_side)]] = std::uint64_t;

    static constexpr Word everywhere(unsigned bit) { return ~(bit - 1); }
    /// 255 for each bit that is set.
    static Bytes bytes(Word word) {
        constexpr std::uint64_t ones = 0x0101010101010101;
        constexpr Bytes bits{1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
        auto const spread = reinterpret_cast<Bytes>(Halves{(word & 255) * ones, (word >> 8 & 255) * ones});
        return reinterpret_cast<Bytes>((spread & bits) != 0);
    }

    Word low_ = 0, high_ = 0;
};

/// The reverse of `put_mask`: kinds in `layer_of`. `turns` is empty where there are but two.
void read_mask(Gaps const& gaps, unsigned kinds, std::span<std::uint8_t const> turns, FrameletShape& shape) {
    std::array<KindRow, framelet_side> rows;
    KindRow row; // all but what has turned in it is as above it
    std::size_t y = 0;
    auto const finish_rows = [&](std::size_t end) {
        for (; (y + 1) * framelet_side <= end; ++y) {
            rows[y] = row;
        }
    };
    std::size_t at = 0, turned = 0;
    for (std::uint8_t const gap : gaps.bytes) {
        at = gap == rest ? framelet_samples : at + gap;
        finish_rows(at);
        if (gap < goes_on) {
            unsigned const turn = turns.empty() ? 1 : turns[turned++];
            if (turn == 0 || turn >= kinds) {
                throw ProtocolError("a shape has a sample on a layer that it does not have");
            }
            std::size_t const x = at % framelet_side;
            row.turn(x, (row[x] + turn) % kinds, y == 0 ? nullptr : &rows[y - 1]);
            ++at;
        }
    }
    finish_rows(framelet_samples);
    SamplePlane in_order;
    for (y = 0; y < framelet_side; ++y) {
        rows[y].write(in_order.data() + y * framelet_side);
    }
    from_rows(in_order.data(), framelet_side, shape.layer_of.data());
}

/// From kinds to layers, with place for what is loose.
void resolve_kinds(std::uint8_t head, FrameletShape& shape) {
    std::uint16_t loose = 0;
    if (head_has_loose(head)) {
        for (std::uint8_t& kind : shape.layer_of) { // without an early end: many at a time
            bool const is_loose = kind >= shape.layer_count;
            kind = is_loose ? FrameletShape::loose : kind;
            loose = static_cast<std::uint16_t>(loose + (is_loose ? 1 : 0));
        }
        if (loose == 0) {
            throw ProtocolError("a shape has none of the loose samples that it announces");
        }
    }
    shape.loose_samples.resize(loose);
}

} // namespace

void encode_masks(std::span<FrameletShape const> shapes, std::vector<std::uint8_t>& out) {
    for (FrameletShape const& shape : shapes) {
        std::size_t loose = 0, none = 0;
        for (std::uint8_t const layer : shape.layer_of) { // without an early end: many at a time
            loose += layer == FrameletShape::loose ? 1 : 0;
            none += layer >= shape.layer_count ? 1 : 0;
        }
        FRAMELET_CHECK(loose == none && loose == shape.loose_samples.size());
    }
    std::vector<std::uint8_t> turns;
    for (FrameletShape const& shape : shapes) {
        if (kinds_of(shape_head(shape)) > 1) {
            put_mask(shape, out, turns);
        }
    }
    out.insert(out.end(), turns.begin(), turns.end());
}

void decode_masks(ByteCursor& bytes, std::span<std::uint8_t const> heads, std::span<FrameletShape> shapes) {
    std::vector<Gaps> gaps;
    for (std::uint8_t const head : heads) {
        gaps.push_back(kinds_of(head) > 1 ? take_gaps(bytes) : Gaps{});
    }
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        unsigned const kinds = kinds_of(heads[i]);
        if (kinds > 1) {
            read_mask(gaps[i], kinds, bytes.take(kinds > 2 ? gaps[i].others : 0), shapes[i]);
        } else {
            shapes[i].layer_of.fill(0);
        }
        resolve_kinds(heads[i], shapes[i]);
    }
}

} // namespace framelet
