#include "common/held/framelet_cache.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/error.h"
#include "common/held/block_flags.h"

namespace framelet {

namespace {

int ceil_div(int value, int divisor) {
    return (value + divisor - 1) / divisor;
}

std::size_t bytes_behind(HeldShape const& shape) {
    return shape.outliers.capacity() * sizeof(HeldOutlier);
}

} // namespace

std::unique_ptr<FrameletRoom::Chunk> FrameletRoom::take() {
    if (spare_.empty()) {
        return std::make_unique<Chunk>();
    }
    std::unique_ptr<Chunk> chunk = std::move(spare_.back());
    spare_.pop_back();
    return chunk;
}

void FrameletRoom::give(std::unique_ptr<Chunk> chunk) {
    if (spare_.size() < most_spare_) {
        spare_.push_back(std::move(chunk));
    }
}

FrameletCache::FrameletCache(ImagePlane plane, FrameletRoom* room)
    : plane_(plane), room_(room), finest_(plane.min_depth() - 1) {
    Viewport const viewport = plane.viewport();
    std::size_t nodes = 0;
    std::size_t squares = 0;
    constexpr int square_side = SquareVersions::side;
    for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
        int const side = plane.tile_side(make_tile(depth, 0, 0));
        Level level{ceil_div(viewport.width, side), ceil_div(viewport.height, side), nodes, 0, squares};
        nodes += static_cast<std::size_t>(level.columns) * static_cast<std::size_t>(level.rows);
        level.square_columns = static_cast<std::size_t>(ceil_div(level.columns, square_side));
        squares += level.square_columns * static_cast<std::size_t>(ceil_div(level.rows, square_side));
        levels_.push_back(level);
    }
    square_changes_.resize(squares);
    make_room(plane.pixel_depth());
    Level const& blocks = level(plane.pixel_depth());
    changed_blocks_.resize(static_cast<std::size_t>(blocks.columns) * static_cast<std::size_t>(blocks.rows));
}

/// Makes room for framelets of this depth.
void FrameletCache::make_room(int depth) {
    if (depth > finest_) {
        finest_ = depth;
        bool const is_last = depth == plane_.max_depth();
        Level const& last = level(depth);
        nodes_.resize(last.first + static_cast<std::size_t>(last.columns) * static_cast<std::size_t>(last.rows));
        versions_.resize(is_last ? square_changes_.size() : level(depth + 1).first_square);
    }
}

std::uint64_t FrameletCache::covered_below(int depth, int column, int row) const {
    if (depth >= finest_) {
        return 0;
    }
    std::uint64_t lowest = std::numeric_limits<std::uint64_t>::max();
    for_each_child(depth, column, row, [&](int x, int y) { lowest = std::min(lowest, node(depth + 1, x, y).cover); });
    return lowest;
}

CachedFramelet const* FrameletCache::newest_over(int block_column, int block_row) const {
    int const depth = plane_.pixel_depth();
    CachedFramelet const* newest = nullptr;
    for (int d = plane_.min_depth(); d <= depth; ++d) {
        CachedFramelet const* const found = find(d, block_column >> (depth - d), block_row >> (depth - d));
        if (found != nullptr && (newest == nullptr || found->moment.batch >= newest->moment.batch)) {
            newest = found;
        }
    }
    return newest;
}

std::size_t FrameletCache::insert(Batch const& batch, std::span<std::uint8_t const> chosen) {
    FRAMELET_CHECK(batch.view.viewport == plane_.viewport());
    FRAMELET_CHECK(batch.number > 0); // 0 stands for bare
    FRAMELET_CHECK(batch.shapes.empty() || batch.shapes.size() == batch.framelets.size());
    FRAMELET_CHECK(chosen.empty() || chosen.size() == batch.framelets.size());
    Moment const moment{batch.number, batch.view.number, batch.scene_time};
    std::uint32_t const view = view_of(batch.view.number, batch.view.camera, batch.scene_time);
    std::size_t taken = 0;
    for (std::size_t i = 0; i < batch.framelets.size(); ++i) {
        if (!chosen.empty() && chosen[i] == 0) {
            continue;
        }
        FrameletShape const* const shape = batch.shapes.empty() ? nullptr : &batch.shapes[i];
        taken += insert_one(batch.framelets[i], shape, moment, view) ? 1 : 0;
    }
    return taken;
}

void FrameletCache::take(FrameletCache const& other, std::vector<SentTile>& left) {
    for (std::size_t slot = 0; slot < other.slot_count(); ++slot) {
        if (CachedFramelet const* const framelet = other.at_slot(slot)) {
            HeldView const& from = other.views_[framelet->view];
            if (!take_one(*framelet, view_of(from.number, from.camera, from.scene_time))) {
                left.push_back({framelet->moment.batch, framelet->tile});
            }
        }
    }
}

/// The index in `views_` of the entry for a camera and a scene time.
std::uint32_t FrameletCache::view_of(std::uint64_t number, Camera const& camera, SceneTime scene_time) {
    std::size_t index = views_.size();
    for (std::size_t i = views_.size(); i-- > 0;) {
        if (views_[i].framelets == 0) {
            index = i;
        } else if (views_[i].number == number && views_[i].scene_time == scene_time) {
            return static_cast<std::uint32_t>(i);
        }
    }
    if (index == views_.size()) {
        views_.emplace_back();
    }
    views_[index] = {number, camera, scene_time};
    return static_cast<std::uint32_t>(index);
}

bool FrameletCache::insert_one(DisplayFramelet const& framelet, FrameletShape const* shape, Moment const& moment,
                               std::uint32_t view) {
    FRAMELET_CHECK(plane_.accepts(framelet.tile));
    CachedFramelet* const cached = make_slot(framelet.tile, moment, view);
    if (cached == nullptr) {
        return false;
    }
    shape_bytes_ -= bytes_behind(cached->shape);
    hold(framelet, shape, 1 << std::max(framelet.tile.depth() - plane_.pixel_depth(), 0), cached->samples,
         cached->shape);
    find_ends(static_cast<double>(plane_.tile_side(framelet.tile)) / cached->shape.side, cached->samples,
              cached->shape);
    shape_bytes_ += bytes_behind(cached->shape);
    note_placed(*cached);
    return true;
}

/// Takes a framelet of another cache; false where nothing of it would show.
bool FrameletCache::take_one(CachedFramelet const& framelet, std::uint32_t view) {
    CachedFramelet* const cached = make_slot(framelet.tile, framelet.moment, view);
    if (cached == nullptr) {
        return false;
    }
    shape_bytes_ -= bytes_behind(cached->shape);
    cached->samples = framelet.samples;
    cached->shape = framelet.shape;
    shape_bytes_ += bytes_behind(cached->shape);
    note_placed(*cached);
    return true;
}

/// Gives a slot to a framelet whose samples and shape are still to come; null where nothing of it would show.
CachedFramelet* FrameletCache::make_slot(Tile tile, Moment const& moment, std::uint32_t view) {
    int const depth = tile.depth();
    int const column = static_cast<int>(tile.column());
    int const row = static_cast<int>(tile.row());
    make_room(depth);
    if (is_hidden(depth, column, row, moment.batch)) {
        return nullptr;
    }
    drop_older_below(depth, column, row, moment.batch);
    Node& own = node(depth, column, row);
    if (own.slot != no_slot) {
        drop(own);
    }
    own.slot = take_slot();
    ++count_;
    CachedFramelet& cached = held(own.slot);
    cached.tile = tile;
    slot_tiles_[static_cast<std::size_t>(own.slot)] = tile;
    set_version(tile, changes_ + 1);
    cached.moment = moment;
    cached.view = view;
    return &cached;
}

/// Counts a framelet in, once its samples and shape have come, and marks what it changes.
void FrameletCache::note_placed(CachedFramelet const& cached) {
    int const depth = cached.tile.depth();
    int const column = static_cast<int>(cached.tile.column());
    int const row = static_cast<int>(cached.tile.row());
    ++views_[cached.view].framelets;
    views_[cached.view].moving_framelets += cached.shape.moves ? 1 : 0;
    refresh_upwards(depth, column, row);
    mark(plane_.tile_rect(cached.tile));
    mark_neighbours(cached.tile, cached.moment);
}

/// True when nothing of a framelet would show: something at least as new lies over it or the newer ones below it leave
/// no gap.
bool FrameletCache::is_hidden(int depth, int column, int row, std::uint64_t batch) const {
    for (int d = plane_.min_depth(); d <= depth; ++d) {
        std::int32_t const slot = node(d, column >> (depth - d), row >> (depth - d)).slot;
        if (slot != no_slot && held(slot).moment.batch >= batch + (d < depth ? 1 : 0)) {
            return true;
        }
    }
    return covered_below(depth, column, row) >= batch;
}

void FrameletCache::drop_older_below(int depth, int column, int row, std::uint64_t batch) {
    if (depth == finest_) {
        return;
    }
    for_each_child(depth, column, row, [&](int x, int y) {
        Node& child = node(depth + 1, x, y);
        if (child.held == 0) {
            return;
        }
        if (child.slot != no_slot && held(child.slot).moment.batch < batch) {
            drop(child);
        }
        drop_older_below(depth + 1, x, y, batch);
        refresh(depth + 1, x, y);
    });
}

void FrameletCache::drop(Node& owner) {
    CachedFramelet const& gone = held(owner.slot);
    mark_neighbours(gone.tile, gone.moment); // those that interpolated with it
    set_version(gone.tile, 0);
    --views_[gone.view].framelets;
    views_[gone.view].moving_framelets -= gone.shape.moves ? 1 : 0;
    release(owner.slot);
    owner.slot = no_slot;
    --count_;
}

void FrameletCache::set_version(Tile tile, std::uint64_t version) {
    std::uint32_t const column = tile.column();
    std::uint32_t const row = tile.row();
    constexpr std::uint32_t side = SquareVersions::side;
    std::size_t const square = square_index(tile.depth(), column / side, row / side);
    versions_[square].tiles[morton_index(column % side, row % side)] = version;
    square_changes_[square] = ++changes_;
}

void FrameletCache::release(std::int32_t slot) {
    held(slot).tile = slot_tiles_[static_cast<std::size_t>(slot)] = no_tile;
    free_slots_.push_back(slot);
}

std::int32_t FrameletCache::take_slot() {
    if (free_slots_.empty()) {
        constexpr std::size_t size = std::tuple_size_v<Chunk>;
        auto const first = static_cast<std::int32_t>(chunks_.size() * size);
        chunks_.push_back(room_ != nullptr ? room_->take() : std::make_unique<Chunk>());
        free_slots_.reserve(chunks_.size() * size);
        slot_tiles_.resize(chunks_.size() * size, no_tile);
        for (auto slot = first + static_cast<std::int32_t>(size) - 1; slot >= first; --slot) {
            free_slots_.push_back(slot);
        }
    }
    std::int32_t const slot = free_slots_.back();
    free_slots_.pop_back();
    return slot;
}

/// Brings a node's sums up to date with its children and drops its framelet where they hide it.
void FrameletCache::refresh(int depth, int column, int row) {
    Node& own = node(depth, column, row);
    std::uint64_t const below = covered_below(depth, column, row);
    if (own.slot != no_slot && below >= held(own.slot).moment.batch) {
        drop(own);
    }
    own.cover = std::max(below, own.slot == no_slot ? 0 : held(own.slot).moment.batch);
    own.held = own.slot == no_slot ? 0 : 1;
    if (depth < finest_) {
        for_each_child(depth, column, row, [&](int x, int y) { own.held += node(depth + 1, x, y).held; });
    }
}

/// Brings a node up to date, and then those that it lies in.
void FrameletCache::refresh_upwards(int depth, int column, int row) {
    for (int d = depth; d >= plane_.min_depth(); --d) {
        refresh(d, column >> (depth - d), row >> (depth - d));
    }
}

void FrameletCache::keep(std::span<Tile const> tiles, std::vector<SentTile>& gone) {
    std::vector<std::uint8_t> kept(slot_tiles_.size());
    for (Tile const tile : tiles) {
        std::int32_t const slot =
            node(tile.depth(), static_cast<int>(tile.column()), static_cast<int>(tile.row())).slot;
        if (slot != no_slot) {
            kept[static_cast<std::size_t>(slot)] = 1;
        }
    }
    for (std::size_t slot = 0; slot < slot_tiles_.size(); ++slot) {
        Tile const tile = slot_tiles_[slot];
        if (tile == no_tile || kept[slot] != 0) {
            continue;
        }
        gone.push_back({held(static_cast<std::int32_t>(slot)).moment.batch, tile});
        mark(plane_.tile_rect(tile));
        int const depth = tile.depth();
        int const column = static_cast<int>(tile.column());
        int const row = static_cast<int>(tile.row());
        drop(node(depth, column, row));
        refresh_upwards(depth, column, row);
    }
}

void FrameletCache::add_held(std::vector<SentTile>& framelets) const {
    for (std::size_t slot = 0; slot < slot_tiles_.size(); ++slot) {
        if (!(slot_tiles_[slot] == no_tile)) {
            framelets.push_back({held(static_cast<std::int32_t>(slot)).moment.batch, slot_tiles_[slot]});
        }
    }
}

void FrameletCache::clear() {
    for (std::size_t slot = 0; slot < slot_tiles_.size(); ++slot) {
        if (!(slot_tiles_[slot] == no_tile)) {
            Tile const tile = slot_tiles_[slot];
            set_version(tile, 0);
            mark(plane_.tile_rect(tile));
            release(static_cast<std::int32_t>(slot));
        }
    }
    for (std::unique_ptr<Chunk>& chunk : chunks_) {
        for (CachedFramelet& framelet : *chunk) {
            framelet.shape.outliers = std::vector<HeldOutlier>();
        }
        if (room_ != nullptr) {
            room_->give(std::move(chunk));
        }
    }
    chunks_.clear();
    slot_tiles_.clear();
    free_slots_.clear();
    shape_bytes_ = 0;
    std::ranges::fill(nodes_, Node{});
    views_.clear();
    count_ = 0;
}

void FrameletCache::mark_block(int column, int row) {
    Level const& blocks = level(plane_.pixel_depth());
    std::size_t const index =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(blocks.columns) + static_cast<std::size_t>(column);
    changed_blocks_[index] = 1;
    has_changes_ = true;
}

void FrameletCache::mark(PixelRect rect) {
    Level const& blocks = level(plane_.pixel_depth());
    for (int row = rect.top / block_side; row < std::min(ceil_div(rect.bottom, block_side), blocks.rows); ++row) {
        for (int column = rect.left / block_side; column < std::min(ceil_div(rect.right, block_side), blocks.columns);
             ++column) {
            mark_block(column, row);
        }
    }
}

/// Coarse framelets of the same moment interpolate with what lies next to them: their blocks along this tile's border
/// depend on it. (A sample is at most 8 pixels wide, so one block is enough.)
void FrameletCache::mark_neighbours(Tile tile, Moment const& moment) {
    PixelRect const rect = plane_.tile_rect(tile);
    int const depth = plane_.pixel_depth();
    Level const& blocks = level(depth);
    int const left = rect.left / block_side - 1;
    int const right = ceil_div(rect.right, block_side);
    int const top = rect.top / block_side - 1;
    int const bottom = ceil_div(rect.bottom, block_side);
    auto const visit = [&](int column, int row) {
        if (column < 0 || row < 0 || column >= blocks.columns || row >= blocks.rows) {
            return;
        }
        for (int d = plane_.min_depth(); d < depth; ++d) {
            std::int32_t const slot = node(d, column >> (depth - d), row >> (depth - d)).slot;
            if (slot != no_slot && same_moment(held(slot).moment, moment)) {
                mark_block(column, row);
                return;
            }
        }
    };
    for (int column = left; column <= right; ++column) {
        visit(column, top);
        visit(column, bottom);
    }
    for (int row = top + 1; row < bottom; ++row) {
        visit(left, row);
        visit(right, row);
    }
}

void FrameletCache::take_changed(std::vector<PixelRect>& changed) {
    changed.clear();
    if (has_changes_) {
        take_flagged(changed_blocks_, level(plane_.pixel_depth()).columns, plane_.viewport(), changed);
        has_changes_ = false;
    }
}

double FrameletCache::covered_area(int depth, int column, int row) const {
    Node const& own = node(depth, column, row);
    if (own.held == 0) {
        return 0;
    }
    if (own.cover > 0) {
        PixelRect const rect =
            plane_.tile_rect(make_tile(depth, static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row)));
        Viewport const viewport = plane_.viewport();
        return static_cast<double>(std::min(rect.right, viewport.width) - rect.left) *
               static_cast<double>(std::min(rect.bottom, viewport.height) - rect.top);
    }
    double area = 0;
    for_each_child(depth, column, row, [&](int x, int y) { area += covered_area(depth + 1, x, y); });
    return area;
}

double FrameletCache::coverage() const {
    double area = 0;
    Level const& top = levels_.front();
    for (int row = 0; row < top.rows; ++row) {
        for (int column = 0; column < top.columns; ++column) {
            area += covered_area(plane_.min_depth(), column, row);
        }
    }
    Viewport const viewport = plane_.viewport();
    return area / (static_cast<double>(viewport.width) * static_cast<double>(viewport.height));
}

bool FrameletCache::is_covered_from(int depth) const {
    if (depth > finest_) {
        return false;
    }
    Level const& l = level(depth);
    auto const first = nodes_.begin() + static_cast<std::ptrdiff_t>(l.first);
    return std::all_of(first, first + static_cast<std::ptrdiff_t>(l.columns) * l.rows,
                       [](Node const& node) { return node.cover > 0; });
}

std::size_t FrameletCache::memory_bytes() const {
    return chunks_.size() * sizeof(Chunk) + nodes_.capacity() * sizeof(Node) + slot_tiles_.capacity() * sizeof(Tile) +
           versions_.capacity() * sizeof(SquareVersions) + square_changes_.capacity() * sizeof(std::uint64_t) +
           free_slots_.capacity() * sizeof(std::int32_t) + views_.capacity() * sizeof(HeldView) +
           changed_blocks_.capacity() + shape_bytes_;
}

} // namespace framelet
