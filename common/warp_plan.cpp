#include "common/warp_plan.h"

#include <algorithm>
#include <array>

#include <tbb/parallel_for.h>

namespace framelet {

namespace {

constexpr std::size_t slots_per_chunk = 256;
constexpr std::size_t squares_per_chunk = 32; // of 2x2 blocks
constexpr std::uint32_t patches_per_chunk = slots_per_chunk * (max_layers + 1);
// A square is merged as a whole and each of its blocks as a whole and in quarters at most.
static_assert(patches_per_chunk >= (1 + 4 * 5) * squares_per_chunk);
constexpr int block_side = FrameletCache::block_side;

/// How far off merging may show a sample.
constexpr double merging_pixels = 1.0 / 16;

constexpr unsigned merged_fine = 0b1;
constexpr unsigned merged_finest = 0b11110; ///< all quarters
constexpr unsigned merged_pixels = 0b100000;

/// The blocks that a box which is not empty touches.
PixelRect blocks_of(PixelRect const& box) {
    return {box.left / block_side, box.top / block_side, (box.right - 1) / block_side + 1,
            (box.bottom - 1) / block_side + 1};
}

template <class Visit>
void for_each_block(PixelRect const& box, int columns, Visit const& visit) {
    if (box.empty()) {
        return;
    }
    PixelRect const blocks = blocks_of(box);
    for (int row = blocks.top; row < blocks.bottom; ++row) {
        for (int column = blocks.left; column < blocks.right; ++column) {
            visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column));
        }
    }
}

std::size_t block_count(PixelRect const& box) {
    PixelRect const blocks = blocks_of(box);
    return static_cast<std::size_t>(blocks.width()) * static_cast<std::size_t>(blocks.height());
}

/// Framelets are far apart in memory: what is needed of one is fetched while those before it are worked on.
constexpr std::size_t fetched_ahead = 4;

void prefetch(CachedFramelet const* framelet) {
    if (framelet != nullptr) {
        __builtin_prefetch(framelet);
        __builtin_prefetch(&framelet->shape.layers);
        __builtin_prefetch(&framelet->shape.loose);
    }
}

/// Squares of 2x2 blocks along a side of so many blocks.
std::size_t square_count(int blocks) {
    return static_cast<std::size_t>(blocks + 1) / 2;
}

bool is_before(WarpPatch const& a, WarpPatch const& b) {
    return a.batch != b.batch ? a.batch > b.batch : a.place < b.place;
}

} // namespace

void WarpPlan::make(FrameletCache const& cache, Camera const& display, SceneTime display_time,
                    BodyMotions const& motions) {
    set_size(cache.plane().viewport());
    std::size_t const blocks = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    std::size_t const squares = cache.plane().pixel_depth() > 0 ? square_count(columns_) * square_count(rows_) : 0;
    std::size_t const square_chunks = (squares + squares_per_chunk - 1) / squares_per_chunk;
    chunks_.resize(square_chunks + cache.slot_count() / slots_per_chunk);
    merged_.assign(blocks, 0);
    squares_.resize(squares);
    tbb::parallel_for(std::size_t{0}, square_chunks, [&](std::size_t i) {
        Chunk& chunk = chunks_[i];
        chunk.patches.clear();
        FrameletWarp warp(cache, display, display_time, motions);
        std::size_t const columns = square_count(columns_);
        std::size_t const first = i * squares_per_chunk;
        for (std::size_t index = first; index < std::min(first + squares_per_chunk, squares); ++index) {
            Tile const tile = make_tile(cache.plane().pixel_depth() - 1, static_cast<std::uint32_t>(index % columns),
                                        static_cast<std::uint32_t>(index / columns));
            merge_square(cache, tile, squares_[index], warp, chunk.patches);
        }
    });
    tbb::parallel_for(square_chunks, chunks_.size(), [&](std::size_t i) {
        Chunk& chunk = chunks_[i];
        chunk.patches.clear();
        chunk.splats.clear();
        FrameletWarp warp(cache, display, display_time, motions);
        std::size_t const first = (i - square_chunks) * slots_per_chunk;
        std::array<CachedFramelet const*, slots_per_chunk + fetched_ahead> alone{};
        std::size_t count = 0;
        for (std::size_t slot = first; slot < first + slots_per_chunk; ++slot) {
            Tile const tile = cache.tile_at_slot(slot);
            if (tile != no_tile && !is_merged(cache.plane(), tile)) {
                alone[count++] = cache.at_slot(slot);
            }
        }
        for (std::size_t k = 0; k < count; ++k) {
            prefetch(alone[k + fetched_ahead]);
            warp.add(*alone[k], chunk.patches, chunk.splats);
        }
    });
    limit_entries();
    make_bins();
}

void WarpPlan::make_spares(FrameletCache const& cache, Camera const& display, SceneTime display_time,
                           BodyMotions const& motions) {
    set_size(cache.plane().viewport());
    std::span<Spare const> const spares = cache.spares();
    chunks_.resize((spares.size() + slots_per_chunk - 1) / slots_per_chunk);
    tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t i) {
        Chunk& chunk = chunks_[i];
        chunk.patches.clear();
        chunk.splats.clear();
        FrameletWarp warp(cache, display, display_time, motions);
        std::size_t const first = i * slots_per_chunk;
        for (Spare const& spare : spares.subspan(first, std::min(slots_per_chunk, spares.size() - first))) {
            warp.add(cache.at(spare), chunk.patches, chunk.splats);
        }
    });
    limit_entries();
    make_bins();
}

void WarpPlan::set_size(Viewport viewport) {
    columns_ = (viewport.width + block_side - 1) / block_side;
    rows_ = (viewport.height + block_side - 1) / block_side;
}

/// Framelets of one depth are merged in the largest squares possible: 2x2 blocks, one, a quarter of one.
void WarpPlan::merge_square(FrameletCache const& cache, Tile tile, Square& square, FrameletWarp& warp,
                            std::vector<WarpPatch>& patches) {
    auto const merge = [&](FineSquare& fine, int levels, std::uint32_t index) {
        MergedFramelet const* const merged = fine.merged(levels, index);
        if (merged == nullptr || !(merged->difference <= warp.inverse_depth_within(merging_pixels, *merged))) {
            return false;
        }
        warp.add(*merged, patches); // nothing where it does not show
        return true;
    };
    constexpr std::array<unsigned, finest_levels + 1> whole{merged_pixels, merged_fine, merged_finest};
    for (std::size_t finer = 0; finer <= finest_levels; ++finer) {
        FineSquare& fine = square[finer];
        fine.update(cache, tile, tile.depth() + 1 + static_cast<int>(finer));
        if (merge(fine, 0, 0)) {
            set_merged(tile, 1, whole[finer]);
            continue;
        }
        for (std::uint32_t block = 0; finer > 0 && block < FineSquare::blocks; ++block) {
            if (merge(fine, 1, block)) {
                set_merged(tile.child(block), 0, whole[finer]);
                continue;
            }
            for (std::uint32_t quarter = 0; finer == finest_levels && quarter < 4; ++quarter) {
                if (merge(fine, 2, 4 * block + quarter)) {
                    set_merged(tile.child(block), 0, 2u << quarter);
                }
            }
        }
    }
}

/// Of the blocks so many levels below `over`.
void WarpPlan::set_merged(Tile over, int levels, unsigned flags) {
    for (std::uint32_t i = 0; i < 1u << 2 * levels; ++i) {
        Tile const block{(over.code << 2 * levels) + i};
        if (is_block(block)) {
            merged_[index_of(block)] |= static_cast<std::uint8_t>(flags);
        }
    }
}

bool WarpPlan::is_merged(ImagePlane const& plane, Tile tile) const {
    int const levels = tile.depth() - plane.pixel_depth();
    if (levels < 0) {
        return false;
    }
    unsigned const merged = merged_[index_of(Tile{tile.code >> 2 * levels})];
    unsigned const own = levels == 0 ? merged_pixels : levels == 1 ? merged_fine : 2u << tile.parent().code % 4;
    return (merged & own) != 0;
}

void WarpPlan::limit_entries() {
    std::size_t const most =
        most_patches_per_block * static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    std::size_t total = 0;
    for (Chunk const& chunk : chunks_) {
        for (WarpPatch const& patch : chunk.patches) {
            total += block_count(patch.box);
        }
    }
    if (total <= most) {
        return;
    }
    std::vector<WarpPatch*> order;
    for (Chunk& chunk : chunks_) {
        for (WarpPatch& patch : chunk.patches) {
            order.push_back(&patch);
        }
    }
    std::sort(order.begin(), order.end(), [](WarpPatch const* a, WarpPatch const* b) { return is_before(*a, *b); });
    total = 0;
    for (WarpPatch* const patch : order) {
        total += block_count(patch->box);
        if (total > most) {
            patch->box = {};
            total = most; // of those that follow none has room
        }
    }
}

void WarpPlan::make_bins() {
    std::size_t const blocks = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    first_entry_.assign(blocks + 1, 0);
    for (Chunk const& chunk : chunks_) {
        for (WarpPatch const& patch : chunk.patches) {
            for_each_block(patch.box, columns_, [&](std::size_t block) { ++first_entry_[block + 1]; });
        }
    }
    for (std::size_t i = 0; i < blocks; ++i) {
        first_entry_[i + 1] += first_entry_[i];
    }
    entries_.resize(first_entry_.back());
    next_entry_.assign(first_entry_.begin(), first_entry_.end() - 1);
    for (std::size_t i = 0; i < chunks_.size(); ++i) {
        std::uint32_t entry = static_cast<std::uint32_t>(i) * patches_per_chunk;
        for (WarpPatch const& patch : chunks_[i].patches) {
            for_each_block(patch.box, columns_, [&](std::size_t block) { entries_[next_entry_[block]++] = entry; });
            ++entry;
        }
    }
}

void WarpPlan::block(std::size_t index, std::vector<PatchView>& patches) const {
    patches.clear();
    for (std::uint32_t i = first_entry_[index]; i < first_entry_[index + 1]; ++i) {
        Chunk const& chunk = chunks_[entries_[i] / patches_per_chunk];
        patches.push_back({&chunk.patches[entries_[i] % patches_per_chunk], chunk.splats.data()});
    }
    std::sort(patches.begin(), patches.end(),
              [](PatchView const& a, PatchView const& b) { return is_before(*a.patch, *b.patch); });
}

} // namespace framelet
