#include "server/render/cache/light_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "common/mix_bits.h"

namespace framelet {
namespace {

/// Surfaces of one cell that face the same way and have records of their own; more share the last one's parent.
constexpr std::uint32_t most_sheets = 4;
constexpr std::uint32_t next_sheet = 1u << 8; ///< in `CellKey::kind`
/// The coarsest cells are this share of the scene.
constexpr float top_share = 1.0f / 8;
/// Records whose planes are farther apart than this share of a cell are of different surfaces.
constexpr float apart_share = 0.35f;
constexpr float least_cosine = 0.5f; ///< between the normals of a place and of a record that is used there
/// Cells' corners lie off the planes that scenes are built along.
constexpr float lattice_offset = 0.377f;
/// Normals this near to an axis: a surface that stays in one layer of cells.
constexpr float along_axis = 0.999f;

int main_axis(Vec3 const& normal) {
    Vec3 const size = glm::abs(normal);
    if (size.x > size.y && size.x > size.z) {
        return 0;
    }
    return size.y > size.z ? 1 : 2;
}

} // namespace

std::uint32_t LightCells::hash_of(CellKey const& key) {
    auto const pair = [](std::uint32_t high, std::int32_t low) {
        return std::uint64_t{high} << 32 | static_cast<std::uint32_t>(low);
    };
    std::uint64_t const first = mix_in(0, pair(key.kind, key.cell[0]));
    return static_cast<std::uint32_t>(mix_in(first, pair(static_cast<std::uint32_t>(key.cell[1]), key.cell[2])));
}

LightCells::LightCells(float scene_size) : top_size_(std::max(scene_size, 1e-6f) * top_share), slots_(1024) {}

LightCells::Grid LightCells::grid_of(LightPlace const& place, int level) const {
    float const scale = 1 / size(level);
    int const axis = main_axis(place.normal);
    Grid grid;
    grid.flat_axis = std::abs(place.normal[axis]) > along_axis ? axis : -1;
    for (int a = 0; a < 3; ++a) {
        constexpr float most = 1e9f;
        float const at = std::clamp(place.position[a] * scale + lattice_offset, -most, most);
        float const cell = std::floor(at);
        float const low = std::floor(at - 0.5f);
        grid.nearest.cell[static_cast<std::size_t>(a)] = static_cast<std::int32_t>(cell);
        grid.base[static_cast<std::size_t>(a)] = static_cast<std::int32_t>(low);
        grid.part[a] = at - 0.5f - low;
    }
    std::uint32_t const side = static_cast<std::uint32_t>(axis) * 2 + (place.normal[axis] < 0 ? 1 : 0);
    grid.nearest.kind = (place.frame << 10) | (static_cast<std::uint32_t>(level) << 3) | side;
    return grid;
}

float LightCells::level_of(float size) const {
    return std::clamp(std::log2(top_size_ / std::max(1e-20f, size)), 0.0f, static_cast<float>(finest));
}

std::uint32_t LightCells::find(CellKey const& key) const {
    std::size_t const mask = slots_.size() - 1;
    std::uint32_t const hash = hash_of(key);
    for (std::size_t slot = hash & mask;; slot = (slot + 1) & mask) {
        Slot const there = slots_[slot];
        if (there.record == nothing ||
            (there.hash == hash && (there.record == awaited || records_[there.record].key == key))) {
            return there.record;
        }
    }
}

std::uint32_t LightCells::find(LightPlace const& place, int level) const {
    std::uint32_t const found = find_sheet(find(key_of(place, level)), place, level);
    return is_record(found) ? found : nothing;
}

/// Of the records of a cell, `first` and those of its other surfaces, that of the surface that a place is on; `awaited`
/// where that is what `first` is.
std::uint32_t LightCells::find_sheet(std::uint32_t first, LightPlace const& place, int level) const {
    std::uint32_t record = first;
    for (std::uint32_t sheet = 1; is_record(record); ++sheet) {
        LightPlace const& there = records_[record].place;
        if (std::abs(glm::dot(there.normal, place.position - there.position)) < apart_share * size(level) &&
            glm::dot(there.normal, place.normal) > least_cosine) {
            return record;
        }
        CellKey next = records_[record].key;
        next.kind += next_sheet;
        record = sheet < most_sheets ? find(next) : nothing;
    }
    return record;
}

std::uint32_t LightCells::free_sheet(CellKey& key) const {
    std::uint32_t there = find(key);
    for (std::uint32_t sheet = 1; sheet < most_sheets && is_record(there); ++sheet) {
        key.kind += next_sheet;
        there = find(key);
    }
    return is_record(there) ? there : nothing;
}

std::uint32_t LightCells::add(LightRecord const& record) {
    make_room();
    auto const number = count();
    records_.push_back(record);
    insert(number, hash_of(record.key));
    return number;
}

void LightCells::await(CellKey const& key) {
    if (find(key) == nothing) {
        make_room();
        insert(awaited, hash_of(key));
    }
}

void LightCells::keep(std::span<std::uint8_t const> kept) {
    std::vector<std::uint32_t> moved(records_.size(), nothing);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < records_.size(); ++i) { // what is around was made before it
        if (kept[i] != 0) {
            moved[i] = count;
            LightRecord& record = records_[count++];
            record = records_[i];
            record.parent = record.parent == nothing ? nothing : moved[record.parent];
        }
    }
    records_.resize(count);
    taken_ = slots_.size();
    make_room();
}

/// Makes sure that one more can be inserted: forgets which cells are awaited, and takes more slots where records alone
/// fill half of what may be filled.
void LightCells::make_room() {
    if (2 * (taken_ + 1) <= slots_.size()) {
        return;
    }
    slots_.assign(std::max(slots_.size(), std::bit_ceil(4 * (records_.size() + 1))), Slot{});
    taken_ = 0;
    for (std::uint32_t i = 0; i < count(); ++i) {
        insert(i, hash_of(records_[i].key));
    }
}

/// A record takes the slot in which it was awaited.
void LightCells::insert(std::uint32_t record, std::uint32_t hash) {
    std::size_t const mask = slots_.size() - 1;
    std::size_t slot = hash & mask;
    while (slots_[slot].record != nothing && !(slots_[slot].record == awaited && slots_[slot].hash == hash)) {
        slot = (slot + 1) & mask;
    }
    taken_ += slots_[slot].record == nothing ? 1 : 0;
    slots_[slot] = {record, hash};
}

} // namespace framelet
