// Remembers what each tile showed when it was last rendered: display-encoded luma, in a table of fixed size that
// forgets what collides. In: rendered framelets. Out: what the same samples were before.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/framelet/framelet.h"

namespace framelet {

class LumaHistory {
public:
    /// Largest value of luma in whole numbers, R + 2 G + B, which stands for `display_luma` 1.
    static constexpr int luma_steps = 4 * 255;

    struct Entry {
        Tile tile{0}; ///< 0: empty
        double time = 0; ///< seconds, on the clock of whoever stores
        double moment = 0; ///< when what it shows was the present, on the same clock
        std::uint64_t content = 0; ///< hash of the samples' colours: equal ones mean equal pictures
        std::array<std::uint16_t, framelet_samples> luma{}; ///< [0, luma_steps], in Morton order
        bool moves = false; ///< it shows something that a viewer which moves its samples moves along
    };

    static constexpr std::size_t default_entries = 8192;

    /// `entries`: a power of 2; more than that many tiles are never remembered.
    explicit LumaHistory(std::size_t entries = default_entries);

    /// The entry of a tile; null where it is not remembered.
    Entry const* find(Tile tile) const;
    void store(Entry const& entry);
    void clear();

private:
    /// Index of the first of the `ways` entries in which a tile may be.
    std::size_t first_slot(Tile tile) const;
    std::size_t ways() const;

    std::vector<Entry> entries_;
};

/// Makes `entry` the framelet's. `time`: when it was rendered; `moment`: when what it shows was the present.
void fill_entry(LumaHistory::Entry& entry, DisplayFramelet const& framelet, double time, double moment);

} // namespace framelet
