#include "server/sampling/model/luma_history.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "common/error.h"
#include "common/mix_bits.h"

namespace framelet {

LumaHistory::LumaHistory(std::size_t entries) : entries_(entries) {
    FRAMELET_CHECK(std::has_single_bit(entries));
}

/// A tile has its choice of so many entries: with one only, a picture's tiles and their parents drive each other out
/// long before the table is full.
std::size_t LumaHistory::ways() const {
    return std::min<std::size_t>(entries_.size(), 4);
}

std::size_t LumaHistory::first_slot(Tile tile) const {
    // Fibonacci hashing: neighbours along the Morton curve land far apart, and so do tiles and their parents.
    return (static_cast<std::size_t>(mix_in(0, tile.code) >> 32) * ways()) & (entries_.size() - 1);
}

LumaHistory::Entry const* LumaHistory::find(Tile tile) const {
    auto const first = entries_.begin() + static_cast<std::ptrdiff_t>(first_slot(tile));
    auto const last = first + static_cast<std::ptrdiff_t>(ways());
    auto const found = std::find_if(first, last, [tile](Entry const& entry) { return entry.tile == tile; });
    return found != last ? &*found : nullptr;
}

void LumaHistory::store(Entry const& entry) {
    // Replaces the entry of the tile, else an empty one, else the oldest.
    auto const rank = [&entry](Entry const& e) { return e.tile == entry.tile ? 0 : e.tile == Tile{0} ? 1 : 2; };
    auto const first = entries_.begin() + static_cast<std::ptrdiff_t>(first_slot(entry.tile));
    *std::min_element(first, first + static_cast<std::ptrdiff_t>(ways()), [&rank](Entry const& a, Entry const& b) {
        return rank(a) != rank(b) ? rank(a) < rank(b) : a.time < b.time;
    }) = entry;
}

void LumaHistory::clear() {
    for (Entry& entry : entries_) {
        entry.tile = Tile{0};
    }
}

void fill_entry(LumaHistory::Entry& entry, DisplayFramelet const& framelet, double time, double moment) {
    entry.tile = framelet.tile;
    entry.time = time;
    entry.moment = moment;
    entry.content = 0;
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        entry.luma[i] = static_cast<std::uint16_t>(framelet.red[i] + 2 * framelet.green[i] + framelet.blue[i]);
    }
    for (auto const* plane : {&framelet.red, &framelet.green, &framelet.blue}) {
        for (std::size_t i = 0; i < framelet_samples; i += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, plane->data() + i, sizeof(word));
            entry.content = mix_in(entry.content, word);
        }
    }
}

} // namespace framelet
