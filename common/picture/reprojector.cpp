#include "common/picture/reprojector.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <utility>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "common/framelet/reprojection.h"
#include "common/held/block_flags.h"
#include "common/mix_bits.h"
#include "common/picture/pixel_filter.h"
#include "common/picture/reconstruction.h"
#include "common/simd/lanes.h"
#include "common/warp/warp_block.h"

namespace framelet {

namespace {

constexpr int side = WarpedBlock::side;

/// Share of what is held that must show. Where less would (after a cut), the rest being made up, all of it stays where
/// it was rendered: that is nearer to what comes (measured on cuts of one scene).
constexpr double least_kept = 0.1;

/// True when nothing of a framelet of this view leaves its place; where it holds something moving (`moves`) only if no
/// time has passed.
bool is_in_place(HeldView const& view, bool moves, Camera const& camera, SceneTime scene_time) {
    bool const same_camera = view.camera == camera || !is_reprojectable(view.camera) || !is_reprojectable(camera);
    return same_camera && (!moves || view.scene_time == scene_time);
}

bool is_all_in_place(FrameletCache const& cache, Camera const& camera, SceneTime scene_time) {
    return std::ranges::all_of(cache.views(), [&](HeldView const& view) {
        return view.framelets == 0 || is_in_place(view, view.moving_framelets > 0, camera, scene_time);
    });
}

/// The same for one framelet; also true where bodies that could move have come to rest.
bool is_in_place(CachedFramelet const& framelet, HeldView const& view, Camera const& camera, SceneTime scene_time,
                 BodyMotions const& motions) {
    return is_in_place(view, framelet.shape.moves, camera, scene_time) ||
           (is_in_place(view, false, camera, scene_time) &&
            is_in_place(framelet.shape, view.scene_time, scene_time, motions));
}

/// True when the block is covered and all framelets of its place are in place.
bool is_block_in_place(FrameletCache const& cache, Camera const& camera, SceneTime scene_time,
                       BodyMotions const& motions, int column, int row) {
    ImagePlane const& plane = cache.plane();
    int const depth = plane.pixel_depth();
    auto const is_fine = [&](CachedFramelet const* framelet) {
        return framelet == nullptr ||
               is_in_place(*framelet, cache.views()[framelet->view], camera, scene_time, motions);
    };
    bool is_covered = cache.covered_below(depth, column, row) > 0;
    for (int d = plane.min_depth(); d <= depth; ++d) {
        CachedFramelet const* const framelet = cache.find(d, column >> (depth - d), row >> (depth - d));
        is_covered |= framelet != nullptr;
        if (!is_fine(framelet)) {
            return false;
        }
    }
    for (int d = depth + 1; d <= cache.finest_depth(); ++d) {
        int const n = 1 << (d - depth);
        for (int i = 0; i < n * n; ++i) {
            if (!is_fine(cache.find(d, n * column + i % n, n * row + i / n))) {
                return false;
            }
        }
    }
    return is_covered;
}

/// The moment whose framelets cover most of the picture.
FrameletCache const& fullest_of(FrameletPool const& pool) {
    std::size_t most = 0;
    for (std::size_t i = 1; i < pool.slot_count(); ++i) {
        most = pool.slot(i).coverage() > pool.slot(most).coverage() ? i : most;
    }
    return pool.slot(most);
}

/// A bit for each slot of which something shows in a block.
std::uint32_t slots_of(WarpedBlock const& block) {
    std::uint32_t slots = 0;
    for (std::int32_t const group : block.group) {
        slots |= group < 0 ? 0 : 1u << slot_of_group(group);
    }
    return slots;
}

std::uint64_t signature_of(std::span<PatchView const> patches, bool in_place) {
    std::uint64_t state = in_place ? 2 : 1;
    for (PatchView const& view : patches) {
        state = mix_in(state, view.patch->signature);
    }
    return state;
}

/// Copies a block of four-byte values into a plane of the viewport's size.
void copy_rows(void const* block, Viewport viewport, int left, int top, void* plane) {
    constexpr std::size_t row_bytes = 4 * side;
    auto const* from = static_cast<std::byte const*>(block);
    std::size_t const pitch = 4 * static_cast<std::size_t>(viewport.width);
    std::byte* to = static_cast<std::byte*>(plane) + static_cast<std::size_t>(top) * pitch + 4 * left;
    std::size_t const bytes = 4 * static_cast<std::size_t>(std::min(side, viewport.width - left));
    for (int y = 0; y < std::min(side, viewport.height - top); ++y, from += row_bytes, to += pitch) {
        if (bytes == row_bytes) {
            std::memcpy(to, from, row_bytes); // of a size that the compiler knows
        } else {
            std::memcpy(to, from, bytes);
        }
    }
}

/// Writes a block's colours, with an alpha of 0 where what shows was moved.
void write_colors(WarpedBlock const& block, int left, int top, Picture& picture) {
    alignas(64) std::array<std::uint32_t, WarpedBlock::pixels> colors;
    for (std::size_t i = 0; i < WarpedBlock::pixels; i += wide_count) {
        auto const bytes = [&](std::size_t channel) {
            WideFloats const value = root(load_lanes<WideFloats>(&block.squares[channel][i])) + 0.5f;
            return reinterpret_cast<WideWords>(__builtin_convertvector(value, WideInts));
        };
        WideInts const is_still = (load_lanes<WideInts>(&block.group[i]) & still_bit) != 0; // holes, too
        WideWords const color = picture_pixels(bytes(0), bytes(1), bytes(2));
        store_lanes(is_still ? color : color & ~picture_pixel(0, 0, 0), &colors[i]);
    }
    copy_rows(colors.data(), {picture.width, picture.height}, left, top, picture.rgba.data());
}

/// Gives a block that stands in its place the picture's colours; pixels for which it lacks inverse depths are
/// infinitely far, not holes. Beyond the picture's border there is nothing.
void take_picture(Picture const& picture, int left, int top, WarpedBlock& block) {
    block.holes = 0;
    for (int y = 0; y < std::min(side, picture.height - top); ++y) {
        std::uint8_t const* pixel = picture.row(top + y) + 4 * left;
        for (int x = 0; x < std::min(side, picture.width - left); ++x, pixel += 4) {
            auto const i = static_cast<std::size_t>(y * side + x);
            block.inverse_depth[i] = std::max(block.inverse_depth[i], 0.0f);
            for (std::size_t channel = 0; channel < 3; ++channel) {
                auto const value = static_cast<float>(pixel[channel]);
                block.squares[channel][i] = value * value;
            }
        }
    }
}

} // namespace

/// True when all that is held stays where it is and no other moment may have what the base of the newest camera lacks.
bool Reprojector::is_in_place(FrameletPool const& pool, Camera const& camera, SceneTime scene_time) const {
    FrameletCache const& newest = pool.newest();
    return !pool.has_moving() && is_all_in_place(newest, camera, scene_time) &&
           (pool.framelet_count() == newest.framelet_count() || newest.is_covered_from(newest.plane().pixel_depth()));
}

void Reprojector::show_exact(FrameletPool const& pool, std::span<PixelRect const> changed, Picture& picture,
                             std::vector<PixelRect>& repainted) {
    if (is_exact_ && exact_slot_ == pool.newest_slot()) {
        reconstruct(pool.newest(), changed, picture);
        repainted.assign(changed.begin(), changed.end());
    } else {
        reconstruct_all(pool.newest(), picture);
        repainted.assign(1, {0, 0, picture.width, picture.height});
    }
    exact_slot_ = pool.newest_slot();
    is_exact_ = true;
    is_on_canvas_ = false;
    noted_slots_ = 0;
    hole_share_ = 0;
}

/// Prepares what is known of blocks. After an exact picture no block is known to be as the plan says; nor is it after
/// one that was painted elsewhere, where it is blank.
void Reprojector::start_moving(Viewport viewport, std::size_t blocks, bool is_blank) {
    bool const is_new = is_exact_ || is_blank || blocks_.size() != blocks;
    if (is_new) {
        blocks_.assign(blocks, {});
    }
    replanned_.assign(blocks, is_new ? 1 : 0);
    auto const pixels = static_cast<std::size_t>(viewport.width) * static_cast<std::size_t>(viewport.height);
    if (unfiltered_.width != viewport.width || unfiltered_.height != viewport.height) {
        unfiltered_ = Picture(viewport.width, viewport.height);
    }
    inverse_depth_.resize(pixels);
    block_means_.resize(blocks);
    painted_.resize(blocks);
    is_exact_ = false;
}

/// Flags the blocks whose patches may be others than the last time; all of them where other slots are the newest one or
/// belong to it.
void Reprojector::flag_replanned(FrameletPool const& pool) {
    std::uint32_t base_slots = 0;
    for (std::size_t i = 0; i < pool.slot_count(); ++i) {
        base_slots |= pool.belongs_to_base(i) ? 1u << i : 0u;
        plans_[i].flag_replanned(replanned_);
    }
    if (newest_slot_ != pool.newest_slot() || base_slots_ != base_slots) {
        std::ranges::fill(replanned_, std::uint8_t{1});
    }
    newest_slot_ = pool.newest_slot();
    base_slots_ = base_slots;
}

void Reprojector::show(FrameletPool const& pool, std::span<PixelRect const> changed, Camera const& camera,
                       SceneTime scene_time, BodyMotions const& motions, Picture& picture,
                       std::vector<PixelRect>& repainted, BlockCanvas* canvas) {
    Viewport const viewport = pool.plane().viewport();
    FRAMELET_CHECK(picture.width == viewport.width && picture.height == viewport.height);
    if (is_in_place(pool, camera, scene_time)) {
        show_exact(pool, changed, picture, repainted);
        has_shown_ = true;
        return;
    }
    while (plans_.size() < pool.slot_count()) {
        plans_.emplace_back();
    }
    noted_slots_ = 0;
    for (std::size_t i = 0; i < pool.slot_count(); ++i) {
        plans_[i].make(pool.slot(i), i, pool.role(i), camera, scene_time, motions);
        noted_slots_ |= pool.is_tried(i) ? 1u << i : 0u;
    }
    columns_ = plans_[0].columns();
    rows_ = plans_[0].rows();
    bool const was_on_canvas = std::exchange(is_on_canvas_, canvas != nullptr);
    bool const is_blank = canvas != nullptr && canvas->begin(this, !has_shown_, viewport);
    start_moving(viewport, static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
                 is_blank || was_on_canvas != is_on_canvas_);
    flag_replanned(pool);
    bool const any = canvas != nullptr ? paint_on(*canvas, pool, camera, scene_time, motions)
                                       : paint_blocks(pool, camera, scene_time, motions);
    if (any) {
        count_blocks(pool.slot_count());
    }
    double const kept = 1 - hole_share_;
    FrameletCache const* const fullest =
        parts_.keeps_cuts && kept < least_kept ? &fullest_of(pool) : nullptr; // coverage takes a while
    if (fullest != nullptr && kept < least_kept * fullest->coverage()) {
        show_cut(*fullest, picture, repainted);
    } else if (canvas != nullptr) {
        repainted.assign(any ? 1u : 0u, {0, 0, viewport.width, viewport.height});
    } else if (any) {
        fill();
        filter(picture, repainted);
    } else {
        repainted.clear();
    }
    has_shown_ = true;
}

/// Paints the blocks that have changed; true when there were any.
bool Reprojector::paint_blocks(FrameletPool const& pool, Camera const& camera, SceneTime scene_time,
                               BodyMotions const& motions) {
    std::atomic<bool> any = false;
    tbb::parallel_for(0, rows_, [&](int row) {
        bool painted = false;
        std::vector<PatchView> patches;
        for (int column = 0; column < columns_; ++column) {
            std::size_t const index = index_of(column, row);
            if (is_wanted(index)) {
                painted |= update_block(pool, camera, scene_time, motions, column, row, patches);
            }
        }
        if (painted) {
            any.store(true, std::memory_order_relaxed);
        }
    });
    return any;
}

/// The same on a canvas. What is to be painted is collected here, where the plan is.
bool Reprojector::paint_on(BlockCanvas& canvas, FrameletPool const& pool, Camera const& camera, SceneTime scene_time,
                           BodyMotions const& motions) {
    std::atomic<bool> any = false, any_job = false;
    row_jobs_.resize(static_cast<std::size_t>(rows_));
    tbb::parallel_for(0, rows_, [&](int row) {
        bool painted = false;
        RowJobs& jobs = row_jobs_[static_cast<std::size_t>(row)];
        jobs.clear();
        std::vector<PatchView> patches;
        for (int column = 0; column < columns_; ++column) {
            std::size_t const index = index_of(column, row);
            if (!is_wanted(index)) {
                continue;
            }
            BlockPatches const found = collect(pool, camera, scene_time, motions, column, row, patches);
            BlockState& state = blocks_[index];
            bool const is_painted = state.signature != found.signature;
            if (!is_painted && (state.slots & noted_slots_) == 0) {
                continue;
            }
            jobs.blocks.push_back({column, row, static_cast<std::uint32_t>(jobs.patches.size()),
                                   static_cast<std::uint32_t>(patches.size()), is_painted, found.in_place});
            jobs.patches.insert(jobs.patches.end(), patches.begin(), patches.end());
            if (is_painted && found.in_place) {
                reconstruct_block(pool.newest(), column, row, unfiltered_);
            }
            state.signature = found.signature;
            painted |= is_painted;
        }
        if (!jobs.blocks.empty()) {
            any_job.store(true, std::memory_order_relaxed);
        }
        if (painted) {
            any.store(true, std::memory_order_relaxed);
        }
    });
    if (!any_job) {
        return false;
    }
    try {
        canvas.paint({pool.plane().viewport(), columns_, rows_, row_jobs_, plans_, unfiltered_, parts_.flat_contrast},
                     reports_);
    } catch (...) {
        blocks_.clear(); // no block is as the plan says
        throw;
    }
    std::size_t next = 0;
    for (RowJobs const& jobs : row_jobs_) {
        for (BlockJob const& job : jobs.blocks) {
            BlockReport const& report = reports_[next++];
            BlockState& state = blocks_[index_of(job.column, job.row)];
            state.holes = report.holes;
            state.slots = report.slots;
        }
    }
    return any;
}

/// Shows a moment as it was rendered.
void Reprojector::show_cut(FrameletCache const& moment, Picture& picture, std::vector<PixelRect>& repainted) {
    is_on_canvas_ = false;
    blocks_.clear(); // no block is as the plan says
    std::ranges::fill(painted_, std::uint8_t{0});
    reconstruct_all(moment, picture);
    repainted.assign(1, {0, 0, picture.width, picture.height});
}

/// Replaces `patches` by those of the block, in order.
Reprojector::BlockPatches Reprojector::collect(FrameletPool const& pool, Camera const& camera, SceneTime scene_time,
                                               BodyMotions const& motions, int column, int row,
                                               std::vector<PatchView>& patches) {
    std::size_t const index = index_of(column, row);
    FrameletCache const& newest = pool.newest();
    patches.clear();
    plans_[pool.newest_slot()].add_block(index, patches);
    std::size_t const newest_patches = patches.size();
    bool in_place = std::ranges::all_of(patches, [](PatchView const& view) { return view.patch->is_still; }) &&
                    is_block_in_place(newest, camera, scene_time, motions, column, row);
    bool const all = !in_place || newest.covered_below(newest.plane().pixel_depth() - 1, column / 2, row / 2) == 0;
    for (std::size_t i = 0; i < pool.slot_count(); ++i) {
        if (pool.belongs_to_base(i) || (all && i != pool.newest_slot())) {
            plans_[i].add_block(index, patches);
        }
    }
    in_place = in_place && patches.size() == newest_patches;
    order(patches);
    return {signature_of(patches, in_place), in_place};
}

bool Reprojector::update_block(FrameletPool const& pool, Camera const& camera, SceneTime scene_time,
                               BodyMotions const& motions, int column, int row, std::vector<PatchView>& patches) {
    std::size_t const index = index_of(column, row);
    auto const [signature, in_place] = collect(pool, camera, scene_time, motions, column, row, patches);
    bool const is_same = signature == blocks_[index].signature;
    if (is_same && (blocks_[index].slots & noted_slots_) == 0) {
        return false;
    }
    Viewport const viewport = pool.plane().viewport();
    int const left = column * side;
    int const top = row * side;
    WarpedBlock block;
    paint_warped_block(patches, column, row, viewport, block);
    if (is_same) { // it was to note what shows
        return false;
    }
    if (in_place) {
        reconstruct_block(pool.newest(), column, row, unfiltered_);
        take_picture(unfiltered_, left, top, block); // holes beside it are filled from what shows in it
    } else {
        write_colors(block, left, top, unfiltered_);
    }
    copy_rows(block.inverse_depth.data(), viewport, left, top, inverse_depth_.data());
    block_means_[index] = far_mean(block);
    blocks_[index] = {signature, block.holes, slots_of(block)};
    painted_[index] = 1;
    return true;
}

bool Reprojector::add_shown(std::size_t slot, std::vector<Tile>& tiles) const {
    if ((noted_slots_ >> slot & 1) == 0) {
        return false;
    }
    plans_[slot].add_shown(tiles);
    return true;
}

void Reprojector::count_blocks(std::size_t slots) {
    std::int64_t holes = 0;
    shown_blocks_.assign(slots, 0);
    for (BlockState const& block : blocks_) {
        holes += block.holes;
        for (std::size_t i = 0; i < slots; ++i) {
            shown_blocks_[i] += block.slots >> i & 1;
        }
    }
    hole_share_ = static_cast<double>(holes) / static_cast<double>(inverse_depth_.size());
}

template <class Work>
void Reprojector::for_each_block(Work const& work) {
    tbb::parallel_for(0, rows_, [&](int row) {
        for (int column = 0; column < columns_; ++column) {
            work(column, row, index_of(column, row));
        }
    });
}

bool Reprojector::is_beside_hole(int column, int row) const {
    for (int y = std::max(row - 1, 0); y < std::min(row + 2, rows_); ++y) {
        for (int x = std::max(column - 1, 0); x < std::min(column + 2, columns_); ++x) {
            if (blocks_[index_of(x, y)].holes > 0) {
                return true;
            }
        }
    }
    return false;
}

/// Holes depend on all that surrounds them, so all of them are filled again.
void Reprojector::fill() {
    if (hole_share_ == 0) {
        return;
    }
    means_.make(block_means_, columns_, rows_);
    cells_.resize(blocks_.size());
    for_each_block([&](int column, int row, std::size_t index) {
        if (is_beside_hole(column, row)) {
            cells_[index] = far_cells(inverse_depth_, unfiltered_, column, row);
        }
    });
    for_each_block([&](int column, int row, std::size_t index) {
        if (blocks_[index].holes > 0) {
            fill_holes(means_, cells_, inverse_depth_, column, row, unfiltered_);
            painted_[index] = 1;
        }
    });
}

/// A block's pixels depend on those beside it: all that lie beside a painted one are written anew. They become
/// `repainted`, in runs along rows: memory is read fastest in its order.
void Reprojector::filter(Picture& picture, std::vector<PixelRect>& repainted) {
    filtered_.assign(painted_.size(), 0);
    for_each_block([&](int column, int row, std::size_t index) {
        auto const is_painted = [&](int x, int y) {
            return x >= 0 && x < columns_ && y >= 0 && y < rows_ && painted_[index_of(x, y)] != 0;
        };
        filtered_[index] = is_painted(column, row) || is_painted(column - 1, row) || is_painted(column + 1, row) ||
                           is_painted(column, row - 1) || is_painted(column, row + 1);
    });
    std::ranges::fill(painted_, std::uint8_t{0});
    take_flagged(filtered_, columns_, {picture.width, picture.height}, repainted);
    tbb::parallel_for(std::size_t{0}, repainted.size(),
                      [&](std::size_t i) { filter_pixels(unfiltered_, repainted[i], picture, parts_.flat_contrast); });
}

} // namespace framelet
