#include "protocol/shape_masks.h"

#include <algorithm>
#include <array>

#include "common/error.h"
#include "protocol/morton_rows.h"

namespace framelet {
namespace {

/// What a sample may be: one of the layers, or loose, which is the last kind.
constexpr unsigned kinds_of(std::uint8_t head) {
    return layers_of_head(head) + (head_has_loose(head) ? 1u : 0u);
}

/// A byte of gaps: so many samples are of the kind that is expected, then one is not; or one of these: so many are, and
/// it goes on; all the rest are.
constexpr std::uint8_t goes_on = 254, rest = 255;

/// In raster order: the kind above, but that to the left where a horizontal edge lies between that and what is above
/// it; in the first row that to the left; 0 for the first.
std::uint8_t expected_kind(SamplePlane const& rows, std::size_t at) {
    if (at < framelet_side) {
        return at > 0 ? rows[at - 1] : std::uint8_t{0};
    }
    std::uint8_t const above = rows[at - framelet_side];
    if (at % framelet_side == 0) {
        return above;
    }
    std::uint8_t const left = rows[at - 1];
    return left == rows[at - framelet_side - 1] ? above : left;
}

/// How far the kinds that come otherwise are from what is expected goes to `turns`, unless there are but two.
void put_mask(FrameletShape const& shape, std::vector<std::uint8_t>& gaps, std::vector<std::uint8_t>& turns) {
    unsigned const kinds = kinds_of(shape_head(shape));
    SamplePlane in_order, rows;
    std::transform(shape.layer_of.begin(), shape.layer_of.end(), in_order.begin(),
                   [loose = shape.layer_count](std::uint8_t layer) { return std::min(layer, loose); });
    to_rows(in_order.data(), rows.data(), framelet_side);
    std::uint8_t gap = 0;
    for (std::size_t at = 0; at < rows.size(); ++at) {
        std::uint8_t const expected = expected_kind(rows, at);
        if (rows[at] == expected) {
            if (++gap == goes_on) {
                gaps.push_back(goes_on);
                gap = 0;
            }
            continue;
        }
        gaps.push_back(gap);
        gap = 0;
        if (kinds > 2) {
            turns.push_back(static_cast<std::uint8_t>((rows[at] + kinds - expected) % kinds));
        }
    }
    if (gap > 0) {
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

/// The reverse of `put_mask`: kinds in `layer_of`. `turns` is empty where there are but two.
void read_mask(Gaps const& gaps, unsigned kinds, std::span<std::uint8_t const> turns, FrameletShape& shape) {
    SamplePlane rows;
    std::size_t at = 0, turned = 0;
    for (std::uint8_t const gap : gaps.bytes) {
        std::size_t const end = gap == rest ? rows.size() : at + gap;
        for (; at < end; ++at) {
            rows[at] = expected_kind(rows, at);
        }
        if (gap < goes_on) {
            unsigned const turn = turns.empty() ? 1 : turns[turned++];
            if (turn == 0 || turn >= kinds) {
                throw ProtocolError("a shape has a sample on a layer that it does not have");
            }
            rows[at] = static_cast<std::uint8_t>((expected_kind(rows, at) + turn) % kinds);
            ++at;
        }
    }
    from_rows(rows.data(), framelet_side, shape.layer_of.data());
}

/// From kinds to layers, with place for what is loose.
void resolve_kinds(std::uint8_t head, FrameletShape& shape) {
    std::size_t loose = 0;
    for (std::uint8_t& kind : shape.layer_of) {
        if (kind >= shape.layer_count) {
            kind = FrameletShape::loose;
            ++loose;
        }
    }
    if (head_has_loose(head) && loose == 0) {
        throw ProtocolError("a shape has none of the loose samples that it announces");
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
