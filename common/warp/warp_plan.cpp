#include "common/warp/warp_plan.h"

#include <algorithm>
#include <bit>

#include <tbb/parallel_for.h>

#include "common/per_thread.h"
#include "common/warp/merging/coplanar_merging.h"

namespace framelet {

namespace {

/// Largest number of patches of a square: what is merged replaces two layers or more.
constexpr std::uint32_t patches_per_square = MergedSquare::most_children * (max_layers + 1);
constexpr int block_side = FrameletCache::block_side;

/// Largest distance, pixels, by which merging may show a sample off its position.
constexpr double merging_pixels = 1.0 / 16;

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
    if (box.empty()) {
        return 0;
    }
    PixelRect const blocks = blocks_of(box);
    return static_cast<std::size_t>(blocks.width()) * static_cast<std::size_t>(blocks.height());
}

/// The rank of a patch in the order of painting. Floats that are not below 0 compare as their bits do.
std::uint64_t rank_of(WarpPatch const& patch) {
    return std::uint64_t{std::bit_cast<std::uint32_t>(patch.worn)} << 32 | (~patch.batch & 0xffffffffu);
}

bool is_before(WarpPatch const& a, WarpPatch const& b) {
    std::uint64_t const rank = rank_of(a), other = rank_of(b);
    return rank != other ? rank < other : a.tile_layer < b.tile_layer;
}

} // namespace

struct WarpPlan::Mergings : PerThread<CoplanarMerging> {};

WarpPlan::WarpPlan() : mergings_(std::make_unique<Mergings>()) {}
WarpPlan::~WarpPlan() = default;
WarpPlan::WarpPlan(WarpPlan&&) noexcept = default;
WarpPlan& WarpPlan::operator=(WarpPlan&&) noexcept = default;

void WarpPlan::Square::clear() {
    before.clear();
    for (WarpPatch const& patch : patches) {
        before.push_back(patch.box);
    }
    patches.clear();
    splats.clear();
    framelets.clear();
}

void WarpPlan::Square::note_number(std::uint32_t number) {
    for (WarpPatch& patch : patches) {
        patch.square = number;
    }
}

void WarpPlan::Square::give_back_room() {
    merged = {};
    patches = std::vector<WarpPatch>();
    splats = std::vector<Splat>();
    framelets = std::vector<std::uint64_t>();
    shows = std::vector<std::uint8_t>();
}

void WarpPlan::make(FrameletCache const& cache, std::size_t slot, SlotRole role, Camera const& display,
                    SceneTime display_time, BodyMotions const& motions) {
    set_squares(cache);
    TimeSpan const valid = motions.between_jumps(display_time);
    bool const is_new = is_limited_ || role != role_ || !(display == display_) || valid != valid_;
    valid_ = valid;
    display_ = display;
    role_ = role;
    replanned_.clear();
    for (std::uint32_t i = 0; i < known_.size(); ++i) {
        Known& known = known_[i];
        std::uint64_t const change = cache.square_changes()[known.index];
        bool const holds = change == 0 || (!is_new && known.lasts.contains(display_time)); // 0: nothing ever was there
        if (known.change != change || !holds) {
            known.change = change;
            replanned_.push_back(i);
        }
    }
    mergings_->prepare();
    tbb::parallel_for(std::size_t{0}, replanned_.size(), [&](std::size_t i) {
        std::uint32_t const index = replanned_[i];
        Square& square = squares_[index];
        square.merged.update(cache, square.tile, square.depth, mergings_->local());
        FrameletWarp warp(cache, slot, role, display, display_time, motions);
        plan(square, role.is_recent, warp);
        square.note_number(index);
        known_[index].lasts = warp.lasts();
        known_[index].is_empty = square.patches.empty();
        known_[index].holds = !square.merged.is_empty();
    });
    give_back_room();
    if (!replanned_.empty() || first_entry_.empty()) {
        occupied_.clear();
        for (std::uint32_t i = 0; i < known_.size(); ++i) {
            if (!known_[i].is_empty) {
                occupied_.push_back(i);
            }
        }
        make_bins();
    }
    for (std::uint32_t const i : occupied_) {
        squares_[i].shows.assign(squares_[i].patches.size(), 0);
    }
}

/// Flags the blocks where patches of replanned squares were, where they are, and those of the squares themselves, whose
/// samples may show in their places.
void WarpPlan::flag_replanned(std::vector<std::uint8_t>& blocks) const {
    auto const flag = [&](PixelRect const& box) {
        for_each_block(box, columns_, [&](std::size_t block) { blocks[block] = 1; });
    };
    for (std::uint32_t const i : replanned_) {
        Square const& square = squares_[i];
        std::ranges::for_each(square.before, flag);
        for (WarpPatch const& patch : square.patches) {
            flag(patch.box);
        }
        PixelRect const rect = plane_.tile_rect(square.tile);
        Viewport const viewport = plane_.viewport();
        flag({rect.left, rect.top, std::min(rect.right, viewport.width), std::min(rect.bottom, viewport.height)});
    }
}

/// Frees the memory of squares in which nothing has been held for a while.
void WarpPlan::give_back_room() {
    for (std::size_t i = 0; i < known_.size(); ++i) {
        Known& known = known_[i];
        if (known.holds) {
            known.empty_pictures = 0;
        } else if (known.empty_pictures < most_empty_pictures) {
            bool const is_finer = squares_[i].depth > plane_.pixel_depth();
            known.empty_pictures = is_finer ? most_empty_pictures : known.empty_pictures + 1;
            if (known.empty_pictures == most_empty_pictures) {
                squares_[i].give_back_room();
            }
        }
    }
}

/// Has a square for each in which something may be held. Those that there are keep their plans.
void WarpPlan::set_squares(FrameletCache const& cache) {
    ImagePlane const& plane = cache.plane();
    if (squares_.empty() || plane != plane_) {
        plane_ = plane;
        columns_ = (plane.viewport().width + block_side - 1) / block_side;
        rows_ = (plane.viewport().height + block_side - 1) / block_side;
        squares_.clear();
        known_.clear();
        first_entry_.clear();
    }
    for (int depth = squares_.empty() ? plane.min_depth() : squares_.back().depth + 1; depth <= cache.finest_depth();
         ++depth) {
        int const square_depth = std::max(depth - MergedSquare::most_levels, 0);
        for (std::uint32_t index = 0; index < 1u << 2 * square_depth; ++index) {
            Tile const tile{(1u << 2 * square_depth) + index};
            if (plane.is_visible(tile)) {
                Square& square = squares_.emplace_back();
                square.tile = tile;
                square.depth = depth;
                known_.emplace_back().index = cache.square_index(depth, tile.column(), tile.row());
            }
        }
    }
}

/// Adds the patch of what is merged, unless it is out of the picture. False where it is not near enough to the layers
/// that it was merged from.
bool WarpPlan::add_merged(MergedLayer const& merged, FrameletWarp& warp, Square& square) {
    if (merged.difference > 0 && !(merged.difference <= warp.inverse_depth_within(merging_pixels, merged))) {
        return false;
    }
    warp.add(merged, square.patches);
    square.note_framelets(merged.parts[0] | merged.parts[1] | merged.parts[2]);
    return true;
}

/// Adds those quads of what is merged that are near enough; the layers that are left are added to `alone`.
void WarpPlan::add_parts(MergedLayer const& merged, FrameletWarp& warp, Square& square, LayerBits& alone) {
    LayerBits left = merged.parts;
    for (CoplanarLayers const& quad : square.merged.quads()) {
        if ((quad.parts[0] & ~left[0]) == 0 && quad.parts != merged.parts) {
            MergedLayer part = square.merged.merge(quad);
            part.number = merged.number; // as its samples have
            part.ends_before = merged.ends_before;
            left[0] &= add_merged(part, warp, square) ? ~quad.parts[0] : ~std::uint64_t{0};
        }
    }
    for (std::size_t k = 0; k < max_layers; ++k) {
        alone[k] |= left[k];
    }
}

/// Plans a square: what is merged, then what is left of the framelets.
void WarpPlan::plan(Square& square, bool outliers, FrameletWarp& warp) {
    square.clear();
    LayerBits alone{};
    for (MergedLayer const& merged : square.merged.merged()) {
        if (!add_merged(merged, warp, square)) {
            add_parts(merged, warp, square, alone);
        }
    }
    std::span<MergedSquare::Child const> const children = square.merged.children();
    std::uint64_t const with_outliers = outliers ? square.merged.children_with_outliers() : 0;
    for (std::uint64_t left = alone[0] | alone[1] | alone[2] | with_outliers; left != 0; left &= left - 1) {
        auto const index = static_cast<std::size_t>(std::countr_zero(left));
        unsigned parts = static_cast<unsigned>(with_outliers >> index & 1) << FrameletShape::outlier;
        for (std::size_t k = 0; k < max_layers; ++k) {
            parts |= static_cast<unsigned>(alone[k] >> index & 1) << k;
        }
        warp.add(*children[index].framelet, parts, square.patches, square.splats);
        square.note_framelets(std::uint64_t{1} << index);
    }
}

/// Counts the patches of each block into `first_entry_`; false where they are more than `most` together.
bool WarpPlan::count_entries(std::size_t most) {
    first_entry_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    std::size_t total = 0;
    for (std::uint32_t const i : occupied_) {
        for (WarpPatch const& patch : squares_[i].patches) {
            total += block_count(patch.box);
            if (total > most) {
                return false;
            }
            for_each_block(patch.box, columns_, [&](std::size_t block) { ++first_entry_[block + 1]; });
        }
    }
    return true;
}

void WarpPlan::limit_entries(std::size_t most) {
    std::vector<WarpPatch*> order;
    for (std::uint32_t const i : occupied_) {
        for (WarpPatch& patch : squares_[i].patches) {
            order.push_back(&patch);
        }
    }
    std::sort(order.begin(), order.end(), [](WarpPatch const* a, WarpPatch const* b) { return is_before(*a, *b); });
    std::size_t total = 0;
    for (WarpPatch* const patch : order) {
        total += block_count(patch->box);
        if (total > most) {
            patch->box = {};
            total = most; // none of those that follow has room
        }
    }
}

void WarpPlan::make_bins() {
    std::size_t const blocks = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    std::size_t const most = most_patches_per_block * blocks;
    is_limited_ = !count_entries(most);
    if (is_limited_) {
        limit_entries(most);
        count_entries(most);
    }
    for (std::size_t i = 0; i < blocks; ++i) {
        first_entry_[i + 1] += first_entry_[i];
    }
    entries_.resize(first_entry_.back());
    next_entry_.assign(first_entry_.begin(), first_entry_.end() - 1);
    for (std::uint32_t const i : occupied_) {
        std::uint32_t entry = i * patches_per_square;
        for (WarpPatch const& patch : squares_[i].patches) {
            for_each_block(patch.box, columns_, [&](std::size_t block) { entries_[next_entry_[block]++] = entry; });
            ++entry;
        }
    }
}

WarpPatch const& WarpPlan::patch_at(std::uint32_t entry) const {
    return squares_[entry / patches_per_square].patches[entry % patches_per_square];
}

void WarpPlan::add_block(std::size_t index, std::vector<PatchView>& patches) {
    for (std::uint32_t i = first_entry_[index]; i < first_entry_[index + 1]; ++i) {
        Square& square = squares_[entries_[i] / patches_per_square];
        std::size_t const patch = entries_[i] % patches_per_square;
        WarpPatch const& own = square.patches[patch];
        patches.push_back({&own, square.splats.data(), &square.shows[patch], rank_of(own)});
    }
    // Fetches from memory the patches of the block that is most likely asked for next.
    std::size_t const next = std::min(index + 2, first_entry_.size() - 1);
    for (std::uint32_t i = first_entry_[index + 1]; i < first_entry_[next]; ++i) {
        auto const* const patch = reinterpret_cast<char const*>(&patch_at(entries_[i]));
        for (std::size_t at = 0; at < sizeof(WarpPatch); at += 64) {
            __builtin_prefetch(patch + at);
        }
    }
}

void WarpPlan::add_shown(std::vector<Tile>& tiles) const {
    for (std::uint32_t const index : occupied_) {
        Square const& square = squares_[index];
        for (std::size_t i = 0; i < square.shows.size(); ++i) {
            if (square.shows[i] != 0) {
                for (std::uint64_t left = square.framelets[i]; left != 0; left &= left - 1) {
                    tiles.push_back(square.merged.child_tile(static_cast<std::size_t>(std::countr_zero(left))));
                }
            }
        }
    }
}

/// A framelet that is not merged has samples of its own, which are in the square's grid too, with other numbers.
std::optional<GridPart> WarpPlan::grid_part(WarpPatch const& patch) const {
    Square const& square = squares_[patch.square];
    if (auto const position = square.merged.position_in_grid(patch.grid)) {
        return GridPart{position->column, position->row, patch.layer, patch.ends_before};
    }
    auto const index = static_cast<std::size_t>(std::countr_zero(square.framelets[number_of(patch)]));
    MergedSquare::Child const& child = square.merged.children()[index];
    auto const [column, row] = square.merged.position_of_child(index);
    GridPart out{column, row, child.numbers[patch.layer], {}};
    for (std::size_t k = 0; k < child.framelet->shape.layer_count; ++k) {
        std::uint32_t const number = child.numbers[k];
        if (k != patch.layer && number == out.number) {
            return std::nullopt;
        }
        out.ends_before[number / 32] |= (patch.ends_before[0] >> k & 1) << number % 32;
    }
    return out;
}

void order(std::vector<PatchView>& patches) {
    std::ranges::sort(patches, [](PatchView const& a, PatchView const& b) {
        return a.rank != b.rank ? a.rank < b.rank : a.patch->tile_layer < b.patch->tile_layer;
    });
}

} // namespace framelet
