#include "client/gpu/patch_table.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>

#include <tbb/parallel_for.h>

namespace framelet {

namespace {

constexpr int side = FrameletCache::block_side;
constexpr std::uint32_t unused = 0xffffffffu;
constexpr std::uint32_t hides_flag = 1, ends_flag = 2; // as in painting.glsl
constexpr std::uint32_t outlier_flag = 1u << 16;
constexpr std::uint32_t most_patches = 1u << 24;

constexpr int part_side = 4; ///< pixels of a part of a block that has its own list of splats
constexpr int parts_across = side / part_side;
constexpr int parts = parts_across * parts_across;

std::uint32_t word(float value) {
    return std::bit_cast<std::uint32_t>(value);
}

std::uint32_t pair(int low, int high) {
    return static_cast<std::uint32_t>(low) | static_cast<std::uint32_t>(high) << 16;
}

/// Writes where a patch lies: its inverse depth, and its maps from the picture to the grid.
void write_maps(WarpPatch const& patch, std::uint32_t* to) {
    to[0] = word(patch.inverse_depth);
    to[1] = word(patch.inverse_depth_dx);
    to[2] = word(patch.inverse_depth_dy);
    to[3] = word(patch.tolerance);
    for (std::size_t i = 0; i < 3; ++i) {
        to[4 + i] = word(patch.at[i]);
        to[7 + i] = word(patch.dx[i]);
        to[10 + i] = word(patch.dy[i]);
    }
}

/// Writes which samples a patch has.
void write_samples(WarpPatch const& patch, GridPart const& part, SampleAtlas::Position position, std::uint32_t* to) {
    std::uint32_t const flags = (patch.hides ? hides_flag : 0) | (patch.has_ends ? ends_flag : 0);
    to[13] = (position.x + static_cast<std::uint32_t>(part.column)) |
             (position.y + static_cast<std::uint32_t>(part.row)) << 10 | position.layer << 20;
    to[14] = static_cast<std::uint32_t>(patch.side) | part.number << 8 | flags << 16;
    std::ranges::copy(part.ends_before, to + 16);
}

/// The part of a box that lies in a block: four bits each of first column, first row, last column, last row.
std::uint32_t local_box(PixelRect const& box, BlockJob const& job) {
    auto const within = [](int value) { return static_cast<std::uint32_t>(std::clamp(value, 0, side - 1)); };
    int const left = job.column * side;
    int const top = job.row * side;
    return within(box.left - left) | within(box.top - top) << 4 | within(box.right - 1 - left) << 8 |
           within(box.bottom - 1 - top) << 12;
}

/// The parts of a block that a splat reaches, in columns or in rows; none where `last` < `first`.
struct Parts {
    int first = 0, last = -1;
};

/// The parts that a splat reaches in one direction. `at`: its middle, pixels from the centre of the block's first
/// pixel. `spacing`: how far it reaches, pixels.
Parts parts_of(float at, float spacing) {
    auto const first = static_cast<int>(std::max(std::ceil(at - spacing), 0.0f));
    auto const last = static_cast<int>(std::min(std::floor(at + spacing), side - 1.0f));
    return last < first ? Parts{} : Parts{first / part_side, last / part_side};
}

} // namespace

std::uint32_t leader_of(std::int32_t group, std::uint32_t index, std::vector<std::int32_t>& groups,
                        std::vector<std::uint32_t>& leaders) {
    auto const known = std::ranges::find(groups, group);
    if (known != groups.end()) {
        return leaders[static_cast<std::size_t>(known - groups.begin())];
    }
    groups.push_back(group);
    leaders.push_back(std::min(index, PatchTable::most_claims - 1));
    return leaders.back();
}

/// Numbers the patches of all squares of which at least one patch is painted.
void PatchTable::find_used(CanvasJobs const& jobs) {
    first_patch_.resize(jobs.plans.size());
    for (std::size_t slot = 0; slot < jobs.plans.size(); ++slot) {
        first_patch_[slot].assign(jobs.plans[slot].square_count(), unused);
    }
    tbb::parallel_for(std::size_t{0}, jobs.row_jobs.size(), [&](std::size_t i) {
        RowJobs const& row = jobs.row_jobs[i];
        for (BlockJob const& job : row.blocks) {
            for (std::uint32_t k = job.first_patch; job.is_painted && k < job.first_patch + job.patches; ++k) {
                WarpPatch const& patch = *row.patches[k].patch;
                std::uint32_t& first = first_patch_[slot_of_group(patch.group)][patch.square];
                std::atomic_ref(first).store(0, std::memory_order_relaxed);
            }
        }
    });
    grids_.clear();
    std::uint32_t next = 0;
    for (std::size_t slot = 0; slot < jobs.plans.size(); ++slot) {
        for (std::uint32_t square = 0; square < first_patch_[slot].size(); ++square) {
            if (first_patch_[slot][square] != unused) {
                first_patch_[slot][square] = next;
                next += static_cast<std::uint32_t>(jobs.plans[slot].patch_count(square));
                grids_.push_back({slot, square, &jobs.plans[slot].square_grid(square)});
            }
        }
    }
    if (next >= most_patches) {
        throw CanvasError("more is to be painted than the graphics card is told of at a time");
    }
    patches.resize(words_of_patch * next);
}

/// Finds the grids of patches that have their samples in no square's grid.
void PatchTable::find_small(CanvasJobs const& jobs) {
    auto const is_small = [](WarpPlan const& plan, WarpPatch const& patch) {
        return !patch.is_outlier && !plan.grid_part(patch);
    };
    first_small_.resize(grids_.size());
    tbb::parallel_for(std::size_t{0}, grids_.size(), [&](std::size_t i) {
        WarpPlan const& plan = jobs.plans[grids_[i].slot];
        first_small_[i] = static_cast<std::uint32_t>(std::ranges::count_if(
            plan.patches_of(grids_[i].square), [&](WarpPatch const& patch) { return is_small(plan, patch); }));
    });
    small_grids_.clear();
    for (std::size_t i = 0; i < grids_.size(); ++i) {
        std::uint32_t const count = first_small_[i];
        first_small_[i] = static_cast<std::uint32_t>(small_grids_.size());
        WarpPlan const& plan = jobs.plans[grids_[i].slot];
        for (WarpPatch const& patch : plan.patches_of(grids_[i].square)) {
            if (count > 0 && is_small(plan, patch)) {
                small_grids_.push_back({patch.grid, patch.side});
            }
        }
    }
}

/// Writes the patches of one of the squares that are used.
void PatchTable::write_square(CanvasJobs const& jobs, SampleAtlas const& atlas, std::size_t index) {
    auto const [slot, square, samples] = grids_[index];
    WarpPlan const& plan = jobs.plans[slot];
    SampleAtlas::Position const position = atlas.position(slot, square);
    std::size_t small_grid = first_small_[index];
    std::uint32_t* to = patches.data() + words_of_patch * first_patch_[slot][square];
    for (WarpPatch const& patch : plan.patches_of(square)) {
        write_maps(patch, to);
        if (!patch.is_outlier) {
            if (auto const part = plan.grid_part(patch)) {
                write_samples(patch, *part, position, to);
            } else {
                write_samples(patch, {0, 0, patch.layer, patch.ends_before}, atlas.small_position(small_grid++), to);
            }
        }
        to += words_of_patch;
    }
}

/// Adds the outliers of a patch that reach into the block, which is the row's last. Returns where their lists begin.
std::uint32_t PatchTable::add_splats(BlockJob const& job, PatchView const& view, std::uint32_t number, Row& row) {
    WarpPatch const& patch = *view.patch;
    std::span<Splat const> const splats(view.splats + patch.first_splat, patch.splats);
    auto const left = static_cast<float>(job.column * side) + 0.5f;
    auto const top = static_cast<float>(job.row * side) + 0.5f;
    auto const block = static_cast<std::uint32_t>(row.blocks.size() / words_of_block - 1);
    auto const first_list = static_cast<std::uint32_t>(row.lists.size());
    auto const for_each_part = [&](Splat const& splat, auto const& visit) {
        Parts const columns = parts_of(splat.x - left, splat.spacing);
        Parts const rows = parts_of(splat.y - top, splat.spacing);
        for (int y = rows.first; columns.first <= columns.last && y <= rows.last; ++y) {
            for (int x = columns.first; x <= columns.last; ++x) {
                visit(static_cast<std::size_t>(y) * parts_across + static_cast<std::size_t>(x));
            }
        }
    };
    std::array<std::uint32_t, parts + 1> ends{};
    for (Splat const& splat : splats) {
        for_each_part(splat, [&](std::size_t part) { ++ends[part + 1]; });
    }
    ends[0] = parts + 1;
    for (std::size_t i = 1; i < ends.size(); ++i) {
        ends[i] += ends[i - 1];
    }
    row.lists.insert(row.lists.end(), ends.begin(), ends.end());
    row.lists.resize(first_list + ends.back());
    for (Splat const& splat : splats) {
        bool is_added = false;
        for_each_part(splat, [&](std::size_t part) {
            if (!is_added) {
                is_added = true;
                row.splats.insert(row.splats.end(), {word(splat.x), word(splat.y), word(splat.inverse_depth),
                                                     word(splat.spacing), splat.sample, block, number, 0u});
            }
            row.lists[first_list + ends[part]++] = static_cast<std::uint32_t>(row.splats.size() / words_of_splat - 1);
        });
    }
    return first_list;
}

void PatchTable::write_row(CanvasJobs const& jobs, RowJobs const& from, Row& row) const {
    row.entries.clear();
    row.lists.clear();
    row.splats.clear();
    row.blocks.clear();
    for (BlockJob const& job : from.blocks) {
        if (!job.is_painted) {
            continue;
        }
        row.groups.clear();
        row.leaders.clear();
        std::uint32_t const count = std::min(job.patches, 0xffffu);
        row.blocks.insert(row.blocks.end(),
                          {pair(job.column, job.row), static_cast<std::uint32_t>(row.entries.size() / words_of_entry),
                           count | (job.is_in_place ? 1u << 16 : 0u), 0u, 0u, 0u, 0u, 0u});
        for (std::uint32_t i = 0; i < count; ++i) {
            PatchView const& view = from.patches[job.first_patch + i];
            WarpPatch const& patch = *view.patch;
            std::size_t const slot = slot_of_group(patch.group);
            std::uint32_t const number =
                first_patch_[slot][patch.square] + static_cast<std::uint32_t>(jobs.plans[slot].number_of(patch));
            row.entries.insert(row.entries.end(), {number | leader_of(patch.group, i, row.groups, row.leaders) << 24,
                                                   local_box(patch.box, job) | (patch.is_outlier ? outlier_flag : 0),
                                                   static_cast<std::uint32_t>(patch.group),
                                                   patch.is_outlier ? add_splats(job, view, i, row)
                                                                    : pair(patch.box.left, patch.box.top)});
        }
    }
}

/// Joins the tables of all rows, one after the other.
void PatchTable::join(std::span<Row const> rows) {
    entries.clear();
    lists.clear();
    splats.clear();
    blocks.clear();
    for (Row const& row : rows) {
        auto const first_entry = static_cast<std::uint32_t>(entries.size() / words_of_entry);
        auto const first_list = static_cast<std::uint32_t>(lists.size());
        auto const first_splat = static_cast<std::uint32_t>(splats.size() / words_of_splat);
        std::size_t const first_block = blocks.size();
        entries.insert(entries.end(), row.entries.begin(), row.entries.end());
        lists.insert(lists.end(), row.lists.begin(), row.lists.end());
        splats.insert(splats.end(), row.splats.begin(), row.splats.end());
        blocks.insert(blocks.end(), row.blocks.begin(), row.blocks.end());
        for (std::size_t i = first_block; i < blocks.size(); i += words_of_block) {
            blocks[i + 1] += first_entry;
            blocks[i + 3] = first_list;
            blocks[i + 4] = first_splat;
        }
        for (std::size_t i = words_of_splat * first_splat; i < splats.size(); i += words_of_splat) {
            splats[i + 5] += static_cast<std::uint32_t>(first_block / words_of_block);
        }
    }
    block_count_ = blocks.size() / words_of_block;
    splat_count_ = splats.size() / words_of_splat;
}

void PatchTable::make(CanvasJobs const& jobs, SampleAtlas& atlas) {
    find_used(jobs);
    find_small(jobs);
    atlas.update(grids_, small_grids_);
    tbb::parallel_for(std::size_t{0}, grids_.size(), [&](std::size_t i) { write_square(jobs, atlas, i); });
    rows_.resize(jobs.row_jobs.size());
    tbb::parallel_for(std::size_t{0}, rows_.size(),
                      [&](std::size_t i) { write_row(jobs, jobs.row_jobs[i], rows_[i]); });
    join(rows_);
}

} // namespace framelet
