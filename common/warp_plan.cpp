#include "common/warp_plan.h"

#include <algorithm>

#include <tbb/parallel_for.h>

namespace framelet {

namespace {

constexpr std::size_t slots_per_chunk = 256;
constexpr std::size_t blocks_per_chunk = 128;
constexpr std::uint32_t patches_per_chunk = slots_per_chunk * (max_layers + 1);
static_assert(patches_per_chunk >= 5 * blocks_per_chunk); // a block is merged as a whole and in quarters at most
constexpr int block_side = FrameletCache::block_side;

/// How far off merging may show a sample.
constexpr double merging_pixels = 1.0 / 16;

constexpr std::uint8_t all_quarters = 0b11110;

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

/// Fetches from memory what merging reads of those framelets below a block that are so many levels finer than pixels.
/// (Where a picture is held as fine framelets they are far apart, and waiting for each costs more than all the rest.)
void prefetch_below(FrameletCache const& cache, Tile block, int levels) {
    int const n = 1 << levels;
    for (int i = 0; i < n * n; ++i) {
        CachedFramelet const* const framelet =
            cache.find(block.depth() + levels, n * static_cast<int>(block.column()) + i % n,
                       n * static_cast<int>(block.row()) + i / n);
        if (framelet == nullptr) {
            return; // not all of them are there, so most will not be looked at
        }
        __builtin_prefetch(framelet);
        __builtin_prefetch(&framelet->shape.layers);
        __builtin_prefetch(&framelet->shape.reduced);
    }
}

bool is_before(WarpPatch const& a, WarpPatch const& b) {
    return a.batch != b.batch ? a.batch > b.batch : a.place < b.place;
}

} // namespace

void WarpPlan::make(FrameletCache const& cache, Camera const& display, SceneTime display_time,
                    BodyMotions const& motions) {
    Viewport const viewport = cache.plane().viewport();
    columns_ = (viewport.width + block_side - 1) / block_side;
    rows_ = (viewport.height + block_side - 1) / block_side;
    std::size_t const blocks = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    std::size_t const slot_chunks = cache.slot_count() / slots_per_chunk;
    chunks_.resize(slot_chunks + (blocks + blocks_per_chunk - 1) / blocks_per_chunk);
    merged_.assign(blocks, 0);
    tbb::parallel_for(slot_chunks, chunks_.size(), [&](std::size_t i) {
        FrameletWarp warp(cache, display, display_time, motions);
        std::size_t const first = (i - slot_chunks) * blocks_per_chunk;
        merge_blocks(cache, first, std::min(first + blocks_per_chunk, blocks), warp, chunks_[i]);
    });
    tbb::parallel_for(std::size_t{0}, slot_chunks, [&](std::size_t i) {
        Chunk& chunk = chunks_[i];
        chunk.patches.clear();
        chunk.splats.clear();
        FrameletWarp warp(cache, display, display_time, motions);
        for (std::size_t slot = i * slots_per_chunk; slot < (i + 1) * slots_per_chunk; ++slot) {
            CachedFramelet const* const framelet = cache.at_slot(slot);
            if (framelet != nullptr && !is_merged(cache.plane(), framelet->tile)) {
                warp.add(*framelet, chunk.patches, chunk.splats);
            }
        }
    });
    limit_entries();
    make_bins();
}

/// A block's framelets are merged all together where possible, else those of its quarters.
void WarpPlan::merge_blocks(FrameletCache const& cache, std::size_t first, std::size_t last, FrameletWarp& warp,
                            Chunk& chunk) {
    chunk.patches.clear();
    chunk.merged.clear();
    int const depth = cache.plane().pixel_depth();
    auto const merge = [&](Tile over, int fine_depth) {
        int const n = 1 << (fine_depth - over.depth());
        CachedFramelet const* const corner =
            cache.find(fine_depth, n * static_cast<int>(over.column()), n * static_cast<int>(over.row()));
        if (corner == nullptr || corner->shape.layer_count != 1) {
            return false;
        }
        double const tolerance = warp.inverse_depth_within(merging_pixels, *corner);
        chunk.merged.emplace_back();
        if (!merge_fine(cache, over, fine_depth, tolerance, chunk.merged.back())) {
            chunk.merged.pop_back();
            return false;
        }
        std::size_t const before = chunk.patches.size();
        warp.add(chunk.merged.back(), chunk.patches);
        if (chunk.patches.size() == before) {
            chunk.merged.pop_back();
        }
        return true;
    };
    auto const tile_of = [&](std::size_t block) {
        auto const columns = static_cast<std::size_t>(columns_);
        return make_tile(depth, static_cast<std::uint32_t>(block % columns),
                         static_cast<std::uint32_t>(block / columns));
    };
    for (std::size_t block = first; block < last; ++block) {
        if (block + 1 < last) {
            prefetch_below(cache, tile_of(block + 1), 1);
            prefetch_below(cache, tile_of(block + 1), 2);
        }
        Tile const tile = tile_of(block);
        unsigned merged = merge(tile, depth + 1) ? 1 : 0;
        if (merge(tile, depth + 2)) {
            merged |= all_quarters;
        } else {
            for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
                merged |= merge(tile.child(quarter), depth + 2) ? 2u << quarter : 0u;
            }
        }
        merged_[block] = static_cast<std::uint8_t>(merged);
    }
    for (std::size_t i = 0; i < chunk.patches.size(); ++i) {
        chunk.patches[i].grid = chunk.merged[i].grid.data();
    }
}

bool WarpPlan::is_merged(ImagePlane const& plane, Tile tile) const {
    int const levels = tile.depth() - plane.pixel_depth();
    if (levels <= 0) {
        return false;
    }
    Tile const block{tile.code >> 2 * levels};
    std::uint8_t const merged = merged_[static_cast<std::size_t>(block.row()) * static_cast<std::size_t>(columns_) +
                                        static_cast<std::size_t>(block.column())];
    return (levels == 1 ? merged & 1u : merged >> (1 + tile.parent().code % 4) & 1u) != 0;
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
