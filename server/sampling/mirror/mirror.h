// Models what a viewer holds (its `FrameletPool`), without its colours: pieces of the moments that it was sent, and
// what they show in the picture of another moment. In: rendered framelets that are sent, where to look from. Out: for
// each cell of that picture how good what the viewer shows there is.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "common/held/framelet_pool.h"
#include "common/per_thread.h"
#include "server/sampling/mirror/cell.h"
#include "server/sampling/mirror/piece_reprojection.h"

namespace framelet {

class Mirror {
public:
    explicit Mirror(Viewport viewport = {});

    Viewport viewport() const { return viewport_; }
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    /// A cell of the picture that was looked at last.
    Cell const& cell(int column, int row) const { return cells_[index_of(column, row)]; }
    /// Pixels of a cell that lie in the viewport.
    int pixels_of(int column, int row) const {
        return std::min(cell_side, viewport_.width - column * cell_side) *
               std::min(cell_side, viewport_.height - row * cell_side);
    }
    Piece const& piece_of(Cell const& cell) const { return moments_[cell.moment].pieces[cell.piece]; }
    /// Position of the middle of that piece in the picture looked at, pixels; `scale_of`: how much larger it is there
    /// than it was rendered; `time_of`: the scene time that it was rendered for.
    SceneTime time_of(Cell const& cell) const { return piece_of(cell).scene_time; }
    Vec2 position_of(Cell const& cell) const { return moments_[cell.moment].reprojected[cell.piece].at; }
    float scale_of(Cell const& cell) const { return moments_[cell.moment].reprojected[cell.piece].scale; }
    /// True where that piece covers a position in the picture looked at.
    bool covers(Cell const& cell, Vec2 at) const {
        ReprojectedPiece const& piece = moments_[cell.moment].reprojected[cell.piece];
        return glm::all(glm::lessThanEqual(glm::abs(at - piece.at), piece.half_side + 0.5f));
    }
    /// The luma that a cell shows at a position in its picture, display-encoded.
    float luma_of(Cell const& cell, Vec2 at) const;
    /// True where a new framelet takes the place of what shows, be it better or not: what shows is of the base of the
    /// camera that is looked through, or out of date, or the viewer moves nothing.
    bool gives_way(Cell const& cell) const {
        return cell.is_outdated || !moves_samples_ || (cell.moment == base_ && moments_[base_].is_of_camera);
    }
    /// True where what shows was rendered for another camera and moved: the viewer interpolates between its samples.
    bool is_moved(Cell const& cell) const { return moves_samples_ && !moments_[cell.moment].is_of_camera; }
    /// False for a viewer that leaves samples where they were rendered.
    bool moves_samples() const { return moves_samples_; }
    /// True when the camera looked through is that of the newest base that had come by then, or none had: as far as is
    /// known, the camera stands.
    bool camera_stands() const { return camera_stands_; }
    /// The moment that was looked at last.
    MirrorView const& view() const { return target_; }
    /// Counts what may change cells: looks, and whatever came or was marked since; `looked`: its value at the last
    /// look.
    std::uint64_t changes() const { return changes_; }
    std::uint64_t looked() const { return looked_; }
    /// True where a cell of a square of 16 pixels a side, or of several, may have changed after `changes` was `since`.
    /// `rect`: pixels, multiples of 16.
    bool has_changed(PixelRect const& rect, std::uint64_t since) const;
    /// True when the picture looked at is of this moment.
    bool looks_at(MirrorView const& view) const;

    /// Finds what the viewer shows of `view` as bodies move by `motions`, in parallel on the calling TBB arena.
    /// `moves_samples`: it moves what it holds, from and to perspective cameras.
    void look(MirrorView const& view, BodyMotions const& motions, bool moves_samples = true);
    /// Adds pieces of one camera and one scene time that the viewer gets, list by list: they are remembered, and shown
    /// at once. In parallel on the calling TBB arena.
    void add(ViewRays const& rays, BodyMotions const& motions, std::span<std::vector<Piece> const> lists);
    void add(ViewRays const& rays, BodyMotions const& motions, std::vector<Piece> const& pieces) {
        add(rays, motions, std::span(&pieces, 1));
    }
    /// Notes that the viewer settles (`FrameletPool::settle`), from the next look on.
    void settle() { settles_ = true; }

    /// Marks the cells of faults, until something rendered with the camera looked through comes there. True where there
    /// are any faults.
    bool mark(std::span<CellFault const> faults);
    /// Notes that the viewer has evicted these framelets, from the next look on.
    void forget(std::span<SentTile const> framelets);

private:
    struct Moment {
        ViewRays rays;
        SceneTime scene_time = 0; ///< of pieces that move
        std::uint64_t number = 0; ///< counts moments in the order in which they came; 0: the slot is free
        std::vector<Piece> pieces;
        std::vector<std::uint32_t> cells; ///< one each: index of the cell below its centre, in the moment's picture
        std::vector<ReprojectedPiece> reprojected; ///< one each, in the picture that is looked at
        bool is_of_camera = false; ///< its camera is the one that is looked through
    };
    std::size_t index_of(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    }
    void erase_forgotten();
    template <class Goes>
    static void erase_pieces(Moment& moment, Goes goes);
    void find_cells(Moment& moment) const;
    std::size_t cell_under(Vec2 at) const;
    void note_changes();
    void note_change(int column, int row) {
        changed_[static_cast<std::size_t>(row / square_cells) * static_cast<std::size_t>(square_columns_) +
                 static_cast<std::size_t>(column / square_cells)] = changes_;
    }
    void find_newest(std::span<Piece const> pieces);
    void replace(Moment& moment, std::size_t count);
    void show_from(Moment& moment, std::size_t first, BodyMotions const& motions);
    bool stands(Piece const& piece) const;
    bool belongs_to_base(Moment const& moment) const { return moment.number > moments_[base_].number; }
    void settle_now();
    static void clear(Moment& moment);
    void empty(Moment& moment) const;
    void give_back_room(Moment& moment) const;
    void begin_base(ViewRays const& rays, SceneTime scene_time);
    Moment& slot_of_moving(SceneTime scene_time);
    Moment& begin_slot(ViewRays const& rays, SceneTime scene_time);
    Moment& free_slot();
    PieceReprojection to_picture(Moment const& moment, BodyMotions const& motions) const;
    void reproject_from(Moment& moment, std::size_t first, BodyMotions const& motions);
    template <class Draw>
    void for_each_band(Draw draw) const;
    void draw(Moment const& moment, std::size_t first, bool is_new, CellRows rows);
    void cover_from(Moment const& moment, std::size_t first, CellRows rows);
    void expect_from(Moment const& moment, std::size_t first, CellRows rows);
    void cover(Moment const& moment, std::size_t index, CellRows rows);
    void show(Moment const& moment, std::size_t index, unsigned mask, int column, int row, bool is_new);
    void put(Moment const& moment, std::size_t index, float inverse_depth, int share, Cell& cell) const;
    bool is_better(Moment const& moment, ReprojectedPiece const& reprojected, float inverse_depth, int share,
                   Cell const& cell) const;
    bool shows_outliers(Moment const& moment) const;

    static constexpr int square_cells = 4; ///< along a side of the squares whose changes are noted

    Viewport viewport_;
    int columns_, rows_, square_columns_;
    std::vector<Cell> cells_;
    std::vector<std::uint64_t> changed_; ///< by square: what `changes_` was when it changed last
    std::uint64_t changes_ = 0, looked_ = 0;
    /// Slots of moments, twice as many as a viewer has, since it says late what it evicts.
    std::array<Moment, 2 * FrameletPool::most_moments> moments_;
    std::unordered_set<std::uint64_t> forgotten_; ///< keys of framelets
    std::uint64_t last_number_ = 0;
    std::size_t base_ = 0; ///< slot of what stands before the newest camera
    bool settles_ = false;
    MirrorView target_;
    bool moves_samples_ = true;
    bool camera_stands_ = false;
    bool awaits_moment_ = false; ///< nothing has come yet of the moment that is looked at

    std::vector<std::uint64_t> newest_batch_; ///< scratch, by cell
    std::vector<Piece> moving_; ///< scratch
    PerThread<BodyTransforms> transforms_; ///< scratch
};

} // namespace framelet
