// Holds for every part of the image plane the newest framelet that arrived, as a quadtree of pooled framelets. In:
// batches in any order. Out: what is shown where, which parts of the picture changed, and how much of it is covered.
// The set that is held depends on the batches inserted, not on the order in which they came.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/framelet/framelet.h"
#include "common/held/held_shape.h"
#include "common/large_blocks.h"

namespace framelet {

/// The batch, camera and scene time that samples are of. Samples of one moment may be interpolated with each other.
struct Moment {
    std::uint64_t batch = 0;
    std::uint64_t camera = 0;
    SceneTime scene_time = 0;
};

/// True when both show the same scene at the same time from the same camera.
constexpr bool same_moment(Moment const& a, Moment const& b) {
    return a.camera == b.camera && (a.batch == b.batch || a.scene_time == b.scene_time);
}

/// A camera and a scene time of which framelets are held.
struct HeldView {
    std::uint64_t number = 0; ///< the camera's
    Camera camera;
    SceneTime scene_time = 0;
    std::uint32_t framelets = 0; ///< how many of them are held; 0: the entry is free
    std::uint32_t moving_framelets = 0; ///< in how many of these something may move: it is on a body or has a velocity
};

/// A framelet as it is held: samples in rows, sample (i, j) at [16 * j + i]. Its parts begin lines of the processor's
/// cache, since few are looked at: the first line has what is needed of every framelet.
struct CachedFramelet {
    alignas(64) Tile tile{0};
    std::uint32_t view = 0; ///< index in the cache's `views`
    Moment moment;
    HeldShape shape;
    alignas(64) std::array<PackedSample, framelet_samples> samples;
};

/// Numbers that tell what has changed in a square of 8x8 tiles of one depth.
struct SquareVersions {
    static constexpr int levels = 3; ///< of the tiles below the square
    static constexpr std::uint32_t side = 1u << levels;

    /// A number for each tile, in Morton order: another one for another framelet that `find` finds, 0 where there is
    /// none.
    std::array<std::uint64_t, side * side> tiles{};
};

/// Code 0 names no tile.
inline constexpr Tile no_tile{0};

/// Memory for framelets that the caches of one viewer hand on to each other. Otherwise each would keep the most that it
/// ever needed: a picture at rest needs many times what a moment of a moving one does.
class FrameletRoom {
public:
    using Chunk = std::array<CachedFramelet, 256>;
    static_assert(sizeof(Chunk) >= least_large_block, "smaller ones would stay with the program");

    /// `most_spare`: how many chunks wait for their next use at most; what is beyond goes back to the system.
    explicit FrameletRoom(std::size_t most_spare) : most_spare_(most_spare) {}

    std::unique_ptr<Chunk> take();
    /// Takes back a chunk, in which no framelet may be held any more.
    void give(std::unique_ptr<Chunk> chunk);
    /// Bytes of the spare chunks.
    std::size_t memory_bytes() const { return spare_.size() * sizeof(Chunk); }

private:
    std::size_t most_spare_;
    std::vector<std::unique_ptr<Chunk>> spare_;
};

/// The newest framelets of one viewport. A pixel shows the framelet of the highest batch number that covers it; of two
/// of the same batch, the finer one. A framelet of which nothing shows is dropped, so that at most one framelet is held
/// for each 4x4 pixels of the viewport. Cameras make no difference to that: pixels are those of each framelet's own
/// image plane, since the newest camera is never far from the one that is displayed, and the only framelet that covers
/// a pixel is never dropped.
///
/// At most 2.45 KB are held for each 4x4 pixels (141 MB at 1280x720), whatever the batches bring.
/// What has changed is reported in blocks of 16x16 pixels, aligned to the picture's corner, and counted by tile.
class FrameletCache {
public:
    static constexpr int block_side = framelet_side;

    /// `room`: must outlive the cache; null: it shares none.
    explicit FrameletCache(ImagePlane plane, FrameletRoom* room = nullptr);

    ImagePlane const& plane() const { return plane_; }

    /// Takes what the batch brings that is newer than what is held; returns how many of its framelets were taken. The
    /// batch's viewport must be the cache's and every tile one that the plane accepts. Work is proportional to the
    /// batch; nothing is allocated unless more framelets are held than ever since the last `clear`. Where there are
    /// flags, only those framelets whose flag is not 0 count.
    std::size_t insert(Batch const& batch, std::span<std::uint8_t const> chosen = {});
    /// Takes what another cache of this plane holds as if it had been inserted. Appends the framelets that are not
    /// taken to `left`.
    void take(FrameletCache const& other, std::vector<SentTile>& left);

    /// Drops all framelets; their memory goes to whoever needs it.
    void clear();
    /// Drops all framelets but those of `tiles`; appends those that were dropped to `gone`.
    void keep(std::span<Tile const> tiles, std::vector<SentTile>& gone);
    /// Appends all framelets that are held.
    void add_held(std::vector<SentTile>& framelets) const;

    /// The cameras and scene times of which framelets are held, and free entries.
    std::span<HeldView const> views() const { return views_; }

    /// Replaces `changed` by the rectangles whose pixels may differ since the last call: disjoint, each one block high
    /// (fewer pixels at the viewport's lower edge), rows from the top.
    void take_changed(std::vector<PixelRect>& changed);

    /// Share of the viewport's area that some framelet covers, [0, 1].
    double coverage() const;
    /// True when framelets of this depth or deeper cover all of the viewport.
    bool is_covered_from(int depth) const;
    std::size_t framelet_count() const { return count_; }
    std::size_t memory_bytes() const;

    // Read access to the quadtree, as for `reconstruct`.

    /// The deepest of the depths at which anything has been held, at least that of pixels: below it there is nothing.
    int finest_depth() const { return finest_; }

    /// The framelet held for exactly this tile, or null. Any column and row may be asked for; the depth must be within
    /// the plane's limits.
    CachedFramelet const* find(int depth, int column, int row) const {
        Level const& l = level(depth);
        if (column < 0 || row < 0 || column >= l.columns || row >= l.rows || depth > finest_) {
            return nullptr;
        }
        std::int32_t const slot = node(depth, column, row).slot;
        return slot == no_slot ? nullptr : &held(slot);
    }
    /// The framelets that are held, by slot in no particular order: from 0 to `slot_count()` - 1, null where a slot is
    /// free.
    std::size_t slot_count() const { return chunks_.size() * std::tuple_size_v<Chunk>; }
    CachedFramelet const* at_slot(std::size_t slot) const {
        return slot_tiles_[slot] == no_tile ? nullptr : &held(static_cast<std::int32_t>(slot));
    }
    /// The versions of the tiles of a depth, `finest_depth` at most, in a visible square, whose column and row are
    /// counted in squares.
    SquareVersions const& versions(int depth, std::uint32_t square_column, std::uint32_t square_row) const {
        return versions_[square_index(depth, square_column, square_row)];
    }
    /// The index of a square in `square_changes`.
    std::size_t square_index(int depth, std::uint32_t square_column, std::uint32_t square_row) const {
        Level const& l = level(depth);
        return l.first_square + square_row * l.square_columns + square_column;
    }
    /// A number for each square, which becomes another one where one of its versions does.
    std::span<std::uint64_t const> square_changes() const { return square_changes_; }
    /// The newest framelet that covers all of a block of 16x16 pixels, of two of one batch the finer one; null where
    /// none does.
    CachedFramelet const* newest_over(int block_column, int block_row) const;
    /// The lowest batch number that shows through where only the tiles below this one are looked at; 0 where they leave
    /// a part of it bare. The tile must be visible.
    std::uint64_t covered_below(int depth, int column, int row) const;

private:
    static constexpr std::int32_t no_slot = -1;

    struct Node {
        std::int32_t slot = no_slot;
        std::uint32_t held = 0; ///< framelets in this subtree, this node's own included
        std::uint64_t cover = 0; ///< lowest batch number that shows through within this subtree; 0: bare somewhere
    };
    /// Tiles of one depth that are visible, in rows.
    struct Level {
        int columns = 0;
        int rows = 0;
        std::size_t first = 0;
        std::size_t square_columns = 0;
        std::size_t first_square = 0;
    };
    using Chunk = FrameletRoom::Chunk;

    Level const& level(int depth) const { return levels_[static_cast<std::size_t>(depth - plane_.min_depth())]; }
    Node const& node(int depth, int column, int row) const {
        Level const& l = level(depth);
        return nodes_[l.first + static_cast<std::size_t>(row) * static_cast<std::size_t>(l.columns) +
                      static_cast<std::size_t>(column)];
    }
    Node& node(int depth, int column, int row) {
        return const_cast<Node&>(std::as_const(*this).node(depth, column, row));
    }
    /// Calls `visit(column, row)` for the visible tiles of the next depth that a tile is made of.
    template <class Visit>
    void for_each_child(int depth, int column, int row, Visit const& visit) const {
        Level const& below = level(depth + 1);
        for (int y = 2 * row; y < std::min(2 * row + 2, below.rows); ++y) {
            for (int x = 2 * column; x < std::min(2 * column + 2, below.columns); ++x) {
                visit(x, y);
            }
        }
    }
    CachedFramelet const& held(std::int32_t slot) const {
        auto const index = static_cast<std::size_t>(slot);
        return (*chunks_[index / std::tuple_size_v<Chunk>])[index % std::tuple_size_v<Chunk>];
    }
    CachedFramelet& held(std::int32_t slot) { return const_cast<CachedFramelet&>(std::as_const(*this).held(slot)); }

    bool insert_one(DisplayFramelet const& framelet, FrameletShape const* shape, Moment const& moment,
                    std::uint32_t view);
    bool take_one(CachedFramelet const& framelet, std::uint32_t view);
    void make_room(int depth);
    CachedFramelet* make_slot(Tile tile, Moment const& moment, std::uint32_t view);
    void note_placed(CachedFramelet const& cached);
    std::uint32_t view_of(std::uint64_t number, Camera const& camera, SceneTime scene_time);
    bool is_hidden(int depth, int column, int row, std::uint64_t batch) const;
    void drop_older_below(int depth, int column, int row, std::uint64_t batch);
    void drop(Node& node);
    void set_version(Tile tile, std::uint64_t version);
    void release(std::int32_t slot);
    std::int32_t take_slot();
    void refresh(int depth, int column, int row);
    void refresh_upwards(int depth, int column, int row);
    void mark(PixelRect rect);
    void mark_neighbours(Tile tile, Moment const& moment);
    void mark_block(int column, int row);
    double covered_area(int depth, int column, int row) const;

    ImagePlane plane_;
    FrameletRoom* room_;
    std::vector<Level> levels_;
    int finest_; ///< deepest level that has nodes and versions: those of framelets finer than pixels are most of all
    std::vector<Node> nodes_;
    std::vector<std::unique_ptr<Chunk>> chunks_;
    std::vector<Tile> slot_tiles_; ///< by slot; `no_tile` where it is free
    std::vector<SquareVersions> versions_; ///< squares of each level in rows
    std::vector<std::uint64_t> square_changes_; ///< by square, kept together since many are looked at
    std::uint64_t changes_ = 0; ///< how many there have been: the newest version
    std::vector<std::int32_t> free_slots_;
    std::vector<HeldView> views_;
    std::size_t shape_bytes_ = 0; ///< bytes that the shapes hold outside of the chunks
    std::vector<std::uint8_t> changed_blocks_; ///< a byte for each block, in rows
    std::size_t count_ = 0;
    bool has_changes_ = false;
};

} // namespace framelet
