#include "server/response/luma_history.h"

#include <bit>
#include <cstring>

#include "common/color.h"
#include "common/error.h"

namespace framelet {

LumaHistory::LumaHistory(std::size_t entries) : entries_(entries) {
    FRAMELET_CHECK(std::has_single_bit(entries));
}

std::size_t LumaHistory::slot(Tile tile) const {
    // Fibonacci hashing: neighbours along the Morton curve land far apart, and so do tiles and their parents.
    std::uint64_t const mixed = std::uint64_t{tile.code} * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(mixed >> 32) & (entries_.size() - 1);
}

LumaHistory::Entry const* LumaHistory::find(Tile tile) const {
    Entry const& entry = entries_[slot(tile)];
    return entry.tile == tile ? &entry : nullptr;
}

void LumaHistory::store(Entry const& entry) {
    entries_[slot(entry.tile)] = entry;
}

void LumaHistory::clear() {
    for (Entry& entry : entries_) {
        entry.tile = Tile{0};
    }
}

LumaHistory::Entry make_entry(DisplayFramelet const& framelet, double time) {
    LumaHistory::Entry entry;
    entry.tile = framelet.tile;
    entry.time = time;
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        entry.luma[i] = display_luma(framelet.red[i], framelet.green[i], framelet.blue[i]);
    }
    for (auto const* plane : {&framelet.red, &framelet.green, &framelet.blue}) {
        for (std::size_t i = 0; i < framelet_samples; i += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, plane->data() + i, sizeof(word));
            entry.content = (entry.content ^ word) * 0xff51afd7ed558ccdu;
            entry.content ^= entry.content >> 32;
        }
    }
    return entry;
}

} // namespace framelet
