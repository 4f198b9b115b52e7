#include "server/sampling/mirror/mirror.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>

namespace framelet {
namespace {

/// Inverse depths that differ by less than this share, beside the tolerance of the piece, belong to one surface.
constexpr float same_surface = 0.02f;
/// A piece that covers fewer pixels of a cell than this shows only where it covers more of them than another.
constexpr int least_share = cell_pixels / 2;
/// Squared luma by which what has drifted for too long is taken to look otherwise than it shows: about as bad as bare.
constexpr float lost_error = 0.05f;
/// More than a viewer can hold is not worth remembering as gone.
constexpr std::size_t most_forgotten = std::size_t{1} << 18;
/// A moment keeps room for a piece for so many cells, which is a quarter of what a picture at rest has.
constexpr std::size_t cells_per_kept_piece = 16;

std::uint64_t key_of(SentTile const& sent) {
    return sent.batch << 32 ^ sent.tile.code;
}

/// Calls `work(begin, end)` for blocks that are [first, last) together, in parallel.
template <class Work>
void for_each_block(std::size_t first, std::size_t last, Work work) {
    constexpr std::size_t at_once = 2048;
    tbb::parallel_for(std::size_t{0}, (last - first + at_once - 1) / at_once, [&](std::size_t block) {
        std::size_t const begin = first + block * at_once;
        work(begin, std::min(begin + at_once, last));
    });
}

} // namespace

Mirror::Mirror(Viewport viewport)
    : viewport_(viewport), columns_((viewport.width + cell_side - 1) / cell_side),
      rows_((viewport.height + cell_side - 1) / cell_side),
      square_columns_((columns_ + square_cells - 1) / square_cells),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
      changed_(static_cast<std::size_t>(square_columns_) *
               static_cast<std::size_t>((rows_ + square_cells - 1) / square_cells)) {}

bool Mirror::has_changed(PixelRect const& rect, std::uint64_t since) const {
    constexpr int side = square_cells * cell_side;
    int const right = std::min(rect.right / side, square_columns_);
    int const bottom = std::min(rect.bottom / side, static_cast<int>(changed_.size()) / std::max(square_columns_, 1));
    for (int row = rect.top / side; row < bottom; ++row) {
        for (int column = rect.left / side; column < right; ++column) {
            if (changed_[static_cast<std::size_t>(row) * static_cast<std::size_t>(square_columns_) +
                         static_cast<std::size_t>(column)] > since) {
                return true;
            }
        }
    }
    return false;
}

/// Notes that any cell may have changed.
void Mirror::note_changes() {
    ++changes_;
    std::ranges::fill(changed_, changes_);
}

bool Mirror::looks_at(MirrorView const& view) const {
    return target_.scene_time == view.scene_time && same_camera(target_.rays, view.rays);
}

void Mirror::look(MirrorView const& view, BodyMotions const& motions, bool moves_samples) {
    target_ = view;
    moves_samples_ = moves_samples;
    camera_stands_ = moments_[base_].number == 0 || same_camera(moments_[base_].rays, view.rays);
    if (std::exchange(settles_, false)) {
        settle_now();
    }
    Moment const& base = moments_[base_];
    awaits_moment_ = base.number > 0 && (!same_camera(base.rays, view.rays) || last_number_ > base.number);
    std::ranges::fill(cells_, Cell{});
    note_changes();
    looked_ = changes_;
    erase_forgotten();
    for (Moment& moment : moments_) {
        reproject_from(moment, 0, motions);
    }
    // Each cell shows what all moments have there, one after the other; cells know nothing of each other.
    for_each_band([&](CellRows rows) {
        for (Moment const& moment : moments_) {
            draw(moment, 0, false, rows);
        }
    });
}

/// Calls `draw(rows)` for bands of rows that are the picture together, in parallel.
template <class Draw>
void Mirror::for_each_band(Draw draw) const {
    int const bands = std::clamp(2 * tbb::this_task_arena::max_concurrency(), 2, 32);
    int const squares = (rows_ + square_cells - 1) / square_cells; // of which each is of one band
    tbb::parallel_for(0, bands, [&](int band) {
        draw(CellRows{squares * band / bands * square_cells,
                      std::min(squares * (band + 1) / bands * square_cells, rows_)});
    });
}

float Mirror::luma_of(Cell const& cell, Vec2 at) const {
    Piece const& piece = piece_of(cell);
    return piece.luma + glm::dot(piece.slope, at - position_of(cell)) / scale_of(cell);
}

bool Mirror::mark(std::span<CellFault const> faults) {
    ++changes_;
    auto const cell_of = [](float pixel, int count) {
        return std::clamp(static_cast<int>(std::round(pixel / float{cell_side})), 0, count);
    };
    for (CellFault const& fault : faults) {
        Vec2 const half(0.5f * static_cast<float>(fault.side));
        Vec2 const low = fault.at - half;
        Vec2 const high = fault.at + half;
        for (int row = cell_of(low.y, rows_); row < cell_of(high.y, rows_); ++row) {
            for (int column = cell_of(low.x, columns_); column < cell_of(high.x, columns_); ++column) {
                Cell& cell = cells_[index_of(column, row)];
                cell.is_wrong = cell.is_wrong || fault.is_wrong;
                cell.stale = std::max(cell.stale, fault.stale);
                note_change(column, row);
            }
        }
    }
    return !faults.empty();
}

void Mirror::forget(std::span<SentTile const> framelets) {
    for (SentTile const& sent : framelets) {
        if (forgotten_.size() < most_forgotten) {
            forgotten_.insert(key_of(sent));
        }
    }
}

/// Erases pieces, in order, for which `goes` is true.
template <class Goes>
void Mirror::erase_pieces(Moment& moment, Goes goes) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < moment.pieces.size(); ++i) {
        if (!goes(moment.pieces[i])) {
            if (kept != i) {
                moment.pieces[kept] = moment.pieces[i];
                moment.cells[kept] = moment.cells[i];
            }
            ++kept;
        }
    }
    moment.pieces.resize(kept);
    moment.cells.resize(kept);
}

/// Finds the cells of the last pieces, for which that was not done yet.
void Mirror::find_cells(Moment& moment) const {
    std::size_t const first = moment.cells.size();
    moment.cells.resize(moment.pieces.size());
    for_each_block(first, moment.pieces.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            moment.cells[i] = static_cast<std::uint32_t>(cell_under(moment.pieces[i].centre));
        }
    });
}

void Mirror::erase_forgotten() {
    for (Moment& moment : moments_) {
        bool const outliers = shows_outliers(moment);
        std::uint64_t last = 0; // pieces of a framelet follow each other
        bool is_gone = false;
        erase_pieces(moment, [&](Piece const& piece) {
            if (std::uint64_t const key = key_of(piece.of); key != last) {
                last = key;
                is_gone = forgotten_.contains(key);
            }
            return is_gone || piece.is_replaced || (piece.is_outlier && !outliers);
        });
        if (moment.pieces.empty() && &moment != &moments_[base_]) {
            moment.number = 0;
        }
        give_back_room(moment);
    }
    forgotten_.clear();
}

void Mirror::add(ViewRays const& rays, BodyMotions const& motions, std::span<std::vector<Piece> const> lists) {
    auto const found = std::ranges::find_if(lists, [](std::vector<Piece> const& list) { return !list.empty(); });
    if (found == lists.end()) {
        return;
    }
    ++changes_;
    SceneTime const scene_time = found->front().scene_time;
    if (moments_[base_].number == 0 || !same_camera(moments_[base_].rays, rays)) {
        begin_base(rays, scene_time);
    }
    Moment& base = moments_[base_];
    std::size_t const first = base.pieces.size();
    moving_.clear();
    for (std::vector<Piece> const& list : lists) {
        for (Piece const& piece : list) {
            (stands(piece) ? base.pieces : moving_).push_back(piece);
        }
    }
    show_from(base, first, motions);
    if (!moving_.empty()) {
        Moment& slot = slot_of_moving(scene_time);
        std::size_t const first_moving = slot.pieces.size();
        slot.pieces.insert(slot.pieces.end(), moving_.begin(), moving_.end());
        show_from(slot, first_moving, motions);
    }
}

/// True where the viewer holds a new piece with what stands.
bool Mirror::stands(Piece const& piece) const {
    return !moves_samples_ || !piece.moves || piece.rests || piece.is_brief ||
           moments_[base_].scene_time == piece.scene_time;
}

/// Shows the pieces of a moment from `first` on, which have just come, in place of those that they replace.
void Mirror::show_from(Moment& moment, std::size_t first, BodyMotions const& motions) {
    find_newest(std::span(moment.pieces).subspan(first));
    for (Moment& held : moments_) { // a viewer that moves nothing shows the newest at each position, of whatever moment
        if (&held == &moment || !moves_samples_) {
            replace(held, &held == &moment ? first : held.pieces.size());
        }
    }
    find_cells(moment);
    reproject_from(moment, first, motions);
    for_each_band([&](CellRows rows) { draw(moment, first, true, rows); });
}

void Mirror::begin_base(ViewRays const& rays, SceneTime scene_time) {
    if (moments_[base_].number > 0) {
        moments_[base_].number = last_number_; // what the last camera saw is as recent as what moved before it
    }
    base_ = static_cast<std::size_t>(&begin_slot(rays, scene_time) - moments_.data());
    note_changes(); // other cells give way
}

/// The slot of what moves at this scene time before the newest camera, since its base began.
Mirror::Moment& Mirror::slot_of_moving(SceneTime scene_time) {
    auto const found = std::ranges::find_if(
        moments_, [&](Moment const& moment) { return belongs_to_base(moment) && moment.scene_time == scene_time; });
    return found != moments_.end() ? *found : begin_slot(moments_[base_].rays, scene_time);
}

Mirror::Moment& Mirror::begin_slot(ViewRays const& rays, SceneTime scene_time) {
    Moment& slot = free_slot();
    slot.rays = rays;
    slot.scene_time = scene_time;
    slot.number = ++last_number_;
    awaits_moment_ = false;
    return slot;
}

/// Moves all pieces of the newest camera into its base. What shows is not known until the next look.
void Mirror::settle_now() {
    Moment& base = moments_[base_];
    std::uint64_t newest = base.number;
    for (Moment& moment : moments_) {
        if (!belongs_to_base(moment)) {
            continue;
        }
        base.pieces.insert(base.pieces.end(), moment.pieces.begin(), moment.pieces.end());
        if (moment.number > newest) {
            newest = moment.number;
            base.scene_time = moment.scene_time;
        }
        empty(moment);
    }
    base.number = newest;
    find_cells(base);
    find_newest(base.pieces);
    replace(base, base.pieces.size());
}

/// A free slot; when all are used, that of the oldest moment, but not the base.
Mirror::Moment& Mirror::free_slot() {
    auto const rank = [this](Moment const& moment) {
        return std::pair(moment.number > 0 && &moment == &moments_[base_], moment.number);
    };
    Moment& free = *std::ranges::min_element(moments_, {}, rank);
    if (free.number > 0) {
        for (Cell& cell : cells_) {
            cell = cell.is_shown() && &moments_[cell.moment] == &free ? Cell{} : cell;
        }
        note_changes();
        clear(free); // its room is needed again at once
    }
    return free;
}

void Mirror::clear(Moment& moment) {
    moment.number = 0;
    moment.pieces.clear();
    moment.cells.clear();
    moment.reprojected.clear();
}

void Mirror::empty(Moment& moment) const {
    clear(moment);
    give_back_room(moment);
}

/// A picture at rest has many times the pieces that one has while things move: not every moment keeps room for that,
/// since after an hour each has held such a picture once.
void Mirror::give_back_room(Moment& moment) const {
    if (moment.pieces.capacity() > std::max(cells_.size() / cells_per_kept_piece, 4 * moment.pieces.size())) {
        moment.pieces.shrink_to_fit();
        moment.cells.shrink_to_fit();
        moment.reprojected.resize(std::min(moment.reprojected.size(), moment.pieces.size()));
        moment.reprojected.shrink_to_fit();
    }
}

std::size_t Mirror::cell_under(Vec2 at) const {
    auto const clamped = [](float pixel, int count) {
        return std::clamp(static_cast<int>(std::floor(pixel)) / cell_side, 0, count - 1);
    };
    return index_of(clamped(at.x, columns_), clamped(at.y, rows_));
}

/// Finds for each cell of their own picture the newest batch of which one of these is.
void Mirror::find_newest(std::span<Piece const> pieces) {
    newest_batch_.assign(cells_.size(), 0);
    auto const columns = static_cast<std::size_t>(columns_);
    for_each_block(0, pieces.size(), [&](std::size_t begin, std::size_t end) {
        for (Piece const& piece : pieces.subspan(begin, end - begin)) {
            std::size_t const low = cell_under(piece.centre - piece.half_side + 0.1f);
            std::size_t const high = cell_under(piece.centre + piece.half_side - 0.1f);
            for (std::size_t row = low / columns; row <= high / columns; ++row) {
                for (std::size_t column = low % columns; column <= high % columns; ++column) {
                    std::atomic_ref const newest(newest_batch_[row * columns + column]); // blocks may share a cell
                    std::uint64_t found = newest.load(std::memory_order_relaxed);
                    while (found < piece.of.batch &&
                           !newest.compare_exchange_weak(found, piece.of.batch, std::memory_order_relaxed)) {
                    }
                }
            }
        }
    });
}

/// Marks those of the first `count` pieces of a moment as replaced that are older than the newest at their position.
void Mirror::replace(Moment& moment, std::size_t count) {
    for_each_block(0, count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            std::uint64_t const newest = newest_batch_[moment.cells[i]];
            if (newest > 0 && moment.pieces[i].of.batch < newest) { // most pieces are not looked at
                moment.pieces[i].is_replaced = true;
            }
        }
    });
}

/// True where outliers of a moment show: those of the base and of the newest moments, of which one may be still to
/// come.
bool Mirror::shows_outliers(Moment const& moment) const {
    return !moves_samples_ || &moment == &moments_[base_] ||
           moment.number + FrameletPool::recent_moments > last_number_ + (awaits_moment_ ? 1 : 0);
}

PieceReprojection Mirror::to_picture(Moment const& moment, BodyMotions const& motions) const {
    Vec2 const size = Vec2(columns_, rows_) * float{cell_side}; // the last cells are whole, too
    return {moment.rays, target_, size, &motions, moves_samples_};
}

/// Finds where the pieces of a moment lie in the picture that is looked at, from `first` on.
void Mirror::reproject_from(Moment& moment, std::size_t first, BodyMotions const& motions) {
    moment.is_of_camera = same_camera(moment.rays, target_.rays);
    moment.reprojected.resize(moment.pieces.size());
    PieceReprojection const reprojection = to_picture(moment, motions);
    bool const outliers = shows_outliers(moment);
    transforms_.prepare();
    for_each_block(first, moment.pieces.size(), [&](std::size_t begin, std::size_t end) {
        reproject(reprojection, std::span(moment.pieces).subspan(begin, end - begin), outliers, transforms_.local(),
                  std::span(moment.reprojected).subspan(begin, end - begin));
    });
}

/// Draws the pieces of a moment, from `first` on, into the cells of these rows. `is_new`: they have just come.
void Mirror::draw(Moment const& moment, std::size_t first, bool is_new, CellRows rows) {
    for (std::size_t i = first; i < moment.pieces.size(); ++i) {
        if (moment.reprojected[i].is_in_picture()) {
            ReprojectedPiece const& piece = moment.reprojected[i];
            for_each_covered(piece.at - piece.half_side, piece.at + piece.half_side, columns_, rows,
                             [&](int column, int row, unsigned mask) { show(moment, i, mask, column, row, is_new); });
        }
    }
    if (&moment == &moments_[base_] && moment.is_of_camera) {
        cover_from(moment, first, rows);
    }
    if (!moves_samples_) {
        expect_from(moment, first, rows);
    }
}

/// Marks where what the pieces of a moment show has gone to, which a viewer that moves nothing does not show there.
void Mirror::expect_from(Moment const& moment, std::size_t first, CellRows rows) {
    for (std::size_t i = first; i < moment.pieces.size(); ++i) {
        ReprojectedPiece const& piece = moment.reprojected[i];
        float const way = glm::length(piece.way);
        if (way < 1) {
            continue;
        }
        float const stale = std::min(moment.pieces[i].detail * way, lost_error);
        Vec2 const at = piece.at + piece.way;
        for_each_covered(at - piece.half_side, at + piece.half_side, columns_, rows,
                         [&](int column, int row, unsigned) {
                             Cell& cell = cells_[index_of(column, row)];
                             cell.stale = std::max(cell.stale, stale);
                             note_change(column, row);
                         });
    }
}

/// Covers the cells of those framelets of the base that are where they were rendered: pieces of a square may leave gaps
/// between each other, its samples do not.
void Mirror::cover_from(Moment const& moment, std::size_t first, CellRows rows) {
    for (std::size_t end = first; first < moment.pieces.size(); first = end) {
        bool is_still = true;
        for (; end < moment.pieces.size() && moment.pieces[end].of == moment.pieces[first].of; ++end) {
            is_still = is_still && (!moment.pieces[end].moves || moment.reprojected[end].is_still);
        }
        for (std::size_t i = first; is_still && i < end; ++i) {
            cover(moment, i, rows);
        }
    }
}

void Mirror::cover(Moment const& moment, std::size_t index, CellRows rows) {
    PixelRect const part = part_of(moment.pieces[index], ImagePlane(viewport_));
    for (int row = std::max(part.top / cell_side, rows.first); row < std::min(part.bottom / cell_side, rows.last);
         ++row) {
        for (int column = part.left / cell_side; column < std::min(part.right / cell_side, columns_); ++column) {
            Cell& cell = cells_[index_of(column, row)];
            cell.covered = 0xffff;
            note_change(column, row);
            if (!cell.is_shown() && moment.reprojected[index].is_in_picture()) {
                put(moment, index, moment.reprojected[index].inverse_depth, 1, cell);
            }
        }
    }
}

/// Covers the pixels `mask` of a cell by a piece, which shows where it is better than what shows.
void Mirror::show(Moment const& moment, std::size_t index, unsigned mask, int column, int row, bool is_new) {
    ReprojectedPiece const& reprojected = moment.reprojected[index];
    Cell& cell = cells_[index_of(column, row)];
    note_change(column, row);
    if (is_new && moment.is_of_camera) {
        cell.is_wrong = false;
        cell.stale = 0;
    }
    if (reprojected.is_lost) { // however little of it shows
        cell.stale = std::max(cell.stale, lost_error);
        if (moment.pieces[index].is_outlier && &moment != &moments_[base_]) {
            return; // a viewer leaves it out
        }
    }
    cell.covered = static_cast<std::uint16_t>(cell.covered | mask);
    Vec2 const middle((static_cast<float>(column) + 0.5f) * cell_side, (static_cast<float>(row) + 0.5f) * cell_side);
    Vec2 const from = glm::clamp(middle - reprojected.at, -reprojected.half_side, reprojected.half_side);
    float const w = std::max(reprojected.inverse_depth + glm::dot(reprojected.depth_slope, from), 0.0f);
    int const share = std::popcount(mask);
    if (is_better(moment, reprojected, w, share, cell)) {
        put(moment, index, w, share, cell);
    }
}

/// Makes a piece what a cell shows.
void Mirror::put(Moment const& moment, std::size_t index, float inverse_depth, int share, Cell& cell) const {
    Piece const& piece = moment.pieces[index];
    ReprojectedPiece const& reprojected = moment.reprojected[index];
    cell.inverse_depth = inverse_depth;
    cell.worn = reprojected.worn;
    cell.leads = reprojected.leads;
    cell.is_outdated = reprojected.is_outdated;
    cell.is_lost = reprojected.is_lost;
    cell.detail = piece.detail / reprojected.scale;
    cell.spacing = piece.spacing;
    cell.decorrelation = reprojected.is_still ? 0 : piece.decorrelation;
    cell.moves = piece.moves && !piece.rests;
    cell.is_supersampled = piece.is_supersampled;
    cell.piece = static_cast<std::uint32_t>(index);
    cell.moment = static_cast<std::uint8_t>(&moment - moments_.data());
    cell.share = static_cast<std::uint8_t>(share);
}

/// True where a piece is better than what a cell shows; of one moment, the later one is.
bool Mirror::is_better(Moment const& moment, ReprojectedPiece const& reprojected, float inverse_depth, int share,
                       Cell const& cell) const {
    if (share < least_share || cell.share < least_share) {
        return share > cell.share;
    }
    if (!moves_samples_) { // what came last shows
        return moment.number >= moments_[cell.moment].number;
    }
    if (reprojected.is_lost || cell.is_lost) {
        return reprojected.is_lost != cell.is_lost ? cell.is_lost : reprojected.worn < cell.worn;
    }
    float const difference = inverse_depth - cell.inverse_depth;
    float const limit = same_surface * std::max(inverse_depth, cell.inverse_depth) + reprojected.tolerance;
    if (std::abs(difference) > limit) {
        return reprojected.leads == cell.leads ? difference > 0 : cell.leads; // a shadow lies on what it darkens
    }
    if (reprojected.is_outdated != cell.is_outdated) {
        return cell.is_outdated;
    }
    if (reprojected.leads != cell.leads) {
        return reprojected.leads;
    }
    return reprojected.worn != cell.worn ? reprojected.worn < cell.worn : moment.number >= moments_[cell.moment].number;
}

} // namespace framelet
