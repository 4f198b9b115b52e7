// The cells of the light cache, in powers of two of size, in the world or in the frame of what moves, and their records
// by hash ([Binder 2018]). In: places. Out: the records there.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "server/render/cache/light_record.h"

namespace framelet {

class LightCells {
public:
    static constexpr std::uint32_t nothing = ~0u; ///< no record
    static constexpr std::uint32_t awaited = ~1u; ///< no record yet
    static bool is_record(std::uint32_t number) { return number < awaited; }
    static constexpr int finest = 14; ///< level of the finest cells

    /// `scene_size`: its diagonal, metres.
    explicit LightCells(float scene_size);

    /// Of the cells of a level, metres.
    float size(int level) const { return top_size_ / static_cast<float>(1u << level); }
    /// The level, between 0 and `finest`, whose cells have this size.
    float level_of(float size) const;
    static int level_in(CellKey const& key) { return static_cast<int>(key.kind >> 3 & 31u); }
    static std::uint32_t hash_of(CellKey const& key);

    std::uint32_t count() const { return static_cast<std::uint32_t>(records_.size()); }
    std::span<LightRecord const> records() const { return records_; }
    LightRecord& operator[](std::uint32_t record) { return records_[record]; }
    LightRecord const& operator[](std::uint32_t record) const { return records_[record]; }
    static constexpr std::size_t bytes_a_record() { return sizeof(LightRecord) + 4 * sizeof(Slot); }

    /// The key of the cell of a level that a place is in, of its first surface.
    CellKey key_of(LightPlace const& place, int level) const { return grid_of(place, level).nearest; }
    /// The record of the surface that a place is on, of the cell of a level that it is in; or `nothing`.
    std::uint32_t find(LightPlace const& place, int level) const;
    /// Moves a cell's key on to a surface that has no record yet. Returns `nothing`; the last surface's record where
    /// all have one.
    std::uint32_t free_sheet(CellKey& key) const;
    /// Returns the record's number.
    std::uint32_t add(LightRecord const& record);
    /// From now on a cell, unless it has records, is one that is to have some: its neighbours are not to speak for it.
    /// That may be forgotten.
    void await(CellKey const& key);
    /// Forgets the records for which `kept` is 0; the others get new numbers, in the same order.
    void keep(std::span<std::uint8_t const> kept);

    /// The eight cells around a place: its neighbours, which are looked up next, have the same ones around them. Good
    /// until records are added.
    struct Around {
        CellKey lowest; ///< of them
        std::array<std::uint32_t, 8> records; ///< of their first surfaces
    };
    /// Visits the records of a level around a place: `visit(NUMBER, WEIGHT, IS_NEAREST)`, by their distance along the
    /// surface; also the cells that are awaited, as is the one that it is in where it has no record. `around`: of a
    /// place nearby, or of none. Returns the key of the cell that it is in.
    template <class Visit>
    CellKey visit_around(LightPlace const& place, int level, Around& around, Visit visit) const;

private:
    struct Slot {
        std::uint32_t record = nothing; ///< or `awaited`
        std::uint32_t hash = 0; ///< of its cell's key: most that do not fit need not be looked at
    };
    /// Where a place lies among the cells of a level.
    struct Grid {
        CellKey nearest; ///< of the cell that it is in
        std::array<std::int32_t, 3> base; ///< the lowest of the eight cells around it
        Vec3 part; ///< from the middle of that to the middle of the highest
        int flat_axis; ///< along which only its own cell counts; -1: none
    };
    static constexpr std::uint32_t not_found_yet = ~2u;

    Grid grid_of(LightPlace const& place, int level) const;
    std::uint32_t find(CellKey const& key) const;
    std::uint32_t find_sheet(std::uint32_t first, LightPlace const& place, int level) const;
    void make_room();
    void insert(std::uint32_t record, std::uint32_t hash);

    float top_size_;
    std::vector<LightRecord> records_;
    std::vector<Slot> slots_; ///< open addressing
    std::size_t taken_ = 0; ///< of `slots_`
};

template <class Visit>
CellKey LightCells::visit_around(LightPlace const& place, int level, Around& around, Visit visit) const {
    Grid const grid = grid_of(place, level);
    CellKey const lowest{grid.base, grid.nearest.kind};
    if (around.lowest != lowest) {
        around.lowest = lowest;
        around.records.fill(not_found_yet);
    }
    for (std::size_t corner = 0; corner < around.records.size(); ++corner) {
        CellKey key = lowest;
        float weight = 1;
        bool counts = true;
        for (int a = 0; a < 3; ++a) {
            std::int32_t& cell = key.cell[static_cast<std::size_t>(a)];
            int const high = static_cast<int>(corner >> a & 1);
            cell += high;
            if (a == grid.flat_axis) {
                counts = counts && cell == grid.nearest.cell[static_cast<std::size_t>(a)];
            } else {
                weight *= high != 0 ? grid.part[a] : 1 - grid.part[a];
            }
        }
        if (!counts) {
            continue;
        }
        std::uint32_t& first = around.records[corner];
        first = first == not_found_yet ? find(key) : first;
        bool const is_nearest = key == grid.nearest;
        std::uint32_t const found = find_sheet(first, place, level);
        std::uint32_t const number = is_nearest && found == nothing ? awaited : found;
        if (number != nothing) {
            visit(number, weight, is_nearest);
        }
    }
    return grid.nearest;
}

} // namespace framelet
