#include "server/sampling/mirror.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include <glm/matrix.hpp>

#include "common/sample_worth.h"

namespace framelet {
namespace {

/// Nearer than this (depth in the picture over depth where it was rendered) nothing is drawn.
constexpr float nearest = 1e-3f;
constexpr float most_pixels = 1e6f, most_scale = 1e6f;
/// A moved piece covers somewhat more, or the gaps that turning and tilting leave between neighbours were holes.
constexpr float widening = 1.1f, margin = 0.5f;
constexpr int cell_pixels = cell_side * cell_side;
/// A piece that covers less of a cell than this is not what it shows, where there is another.
constexpr int least_share = cell_pixels / 2;
/// A viewer lets go of what did not show lately, and of none of its newest moments.
constexpr std::uint8_t most_unshown = 2;
constexpr std::uint64_t newest_kept = 3;
constexpr std::uint8_t replaced_piece = 255; ///< instead of how long it has shown nowhere: it is held no longer

bool same_camera(ViewRays const& a, ViewRays const& b) {
    return a.origin == b.origin && a.direction == b.direction && a.direction_dx == b.direction_dx &&
           a.direction_dy == b.direction_dy;
}

/// Bits [first, last) of four, clipped.
constexpr unsigned bits_between(int first, int last) {
    first = std::max(first, 0);
    last = std::min(last, cell_side);
    return ((1u << last) - 1) & ~((1u << first) - 1);
}

/// Each of four bits to the first of four.
constexpr unsigned spread_rows(unsigned rows) {
    return (rows & 1) | (rows & 2) << 3 | (rows & 4) << 6 | (rows & 8) << 9;
}

} // namespace

Mirror::Mirror(Viewport viewport)
    : viewport_(viewport), columns_((viewport.width + cell_side - 1) / cell_side),
      rows_((viewport.height + cell_side - 1) / cell_side),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

int Mirror::pixels_of(int column, int row) const {
    return std::min(cell_side, viewport_.width - column * cell_side) *
           std::min(cell_side, viewport_.height - row * cell_side);
}

bool Mirror::looks_at(MirrorView const& view) const {
    return target_.scene_time == view.scene_time && same_camera(target_.rays, view.rays);
}

std::size_t Mirror::piece_count() const {
    std::size_t count = 0;
    for (Moment const& moment : moments_) {
        count += moment.pieces.size();
    }
    return count;
}

std::size_t Mirror::moment_count() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(moments_, [](Moment const& moment) { return moment.number > 0; }));
}

void Mirror::look(MirrorView const& view, BodyMotions const& motions) {
    target_ = view;
    auto const newest = std::ranges::max_element(moments_, {}, &Moment::number);
    if (newest->number > 0 && !same_camera(newest->rays, view.rays)) {
        free_slot(); // what comes of this moment takes it: what was held there will not be seen
    }
    std::ranges::fill(cells_, Cell{});
    for (Moment& moment : moments_) {
        std::erase_if(moment.pieces, [&](Piece const& piece) {
            return piece.unshown == replaced_piece ||
                   (piece.unshown >= most_unshown && moment.number + newest_kept <= last_number_);
        });
        place(moment, 0, motions);
    }
    count_shown();
}

void Mirror::add(ViewRays const& rays, BodyMotions const& motions, std::span<Piece const> pieces) {
    if (pieces.empty()) {
        return;
    }
    Moment& moment = slot_of(rays);
    replace(moment, pieces);
    std::size_t const first = moment.pieces.size();
    moment.pieces.insert(moment.pieces.end(), pieces.begin(), pieces.end());
    place(moment, first, motions);
}

/// Of the newest moment; or where that is of another camera a free one.
Mirror::Moment& Mirror::slot_of(ViewRays const& rays) {
    auto const newest = std::ranges::max_element(moments_, {}, &Moment::number);
    if (newest->number > 0 && same_camera(newest->rays, rays)) {
        return *newest;
    }
    Moment& free = free_slot();
    free.rays = rays;
    free.number = ++last_number_;
    return free;
}

/// When all are used, that of the moment that shows least.
Mirror::Moment& Mirror::free_slot() {
    auto const key = [&](Moment const& moment) {
        bool const used = moment.number > 0;
        return std::tuple(used, used && moment.number + newest_kept > last_number_, moment.shown, moment.number);
    };
    auto const goes_first = [&](Moment const& a, Moment const& b) { return key(a) < key(b); };
    Moment& free = *std::ranges::min_element(moments_, goes_first);
    if (free.number > 0) {
        for (Cell& cell : cells_) {
            cell = cell.is_shown() && &moments_[cell.moment] == &free ? Cell{} : cell;
        }
        free.number = 0;
        free.pieces.clear();
        free.placed.clear();
        free.shown = 0;
    }
    return free;
}

/// What a viewer holds of one camera is the newest at each place, of whatever time: the older goes.
void Mirror::replace(Moment& moment, std::span<Piece const> pieces) {
    auto const is_older = [&](Piece const& piece) { return piece.scene_time != pieces.front().scene_time; };
    if (std::ranges::none_of(moment.pieces, is_older)) {
        return;
    }
    auto const clamped = [](float pixel, int count) {
        return std::clamp(static_cast<int>(std::floor(pixel)) / cell_side, 0, count - 1);
    };
    replaced_.assign(cells_.size(), 0);
    for (Piece const& piece : pieces) {
        Vec2 const low = piece.centre - piece.half_side + 0.1f;
        Vec2 const high = piece.centre + piece.half_side - 0.1f;
        for (int row = clamped(low.y, rows_); row <= clamped(high.y, rows_); ++row) {
            for (int column = clamped(low.x, columns_); column <= clamped(high.x, columns_); ++column) {
                replaced_[index_of(column, row)] = 1;
            }
        }
    }
    for (Piece& piece : moment.pieces) {
        std::size_t const cell = index_of(clamped(piece.centre.x, columns_), clamped(piece.centre.y, rows_));
        piece.unshown = is_older(piece) && replaced_[cell] != 0 ? replaced_piece : piece.unshown;
    }
}

Mirror::TurnedBody const& Mirror::turn_to(Moment const& moment, Piece const& piece, BodyMotions const& motions) {
    BodyNumber const body = piece.body;
    if (turned_.size() <= body) {
        turned_.resize(std::size_t{body} + 1);
    }
    TurnedBody& turned = turned_[body];
    if (turned.stamp == stamp_) {
        return turned;
    }
    turned.stamp = stamp_;
    Motion const motion = body == static_body ? Motion{} : motions.between(body, piece.scene_time, target_.scene_time);
    ViewTransform const transform = make_view_transform(moment.rays, target_.rays, motion);
    turned.far = Mat3(transform.far);
    turned.parallax = Vec3(transform.parallax);
    for (std::size_t axis = 0; axis < turned.carried.size(); ++axis) {
        glm::dvec3 metre(0);
        metre[static_cast<int>(axis)] = 1;
        ViewTransform const carried = make_view_transform(moment.rays, target_.rays, motion, metre);
        turned.carried[axis] = Vec3(carried.parallax - transform.parallax);
    }
    turned.lens = static_cast<float>(std::sqrt(std::abs(glm::determinant(transform.far))));
    return turned;
}

/// Of a moment, from piece `first` on.
void Mirror::place(Moment& moment, std::size_t first, BodyMotions const& motions) {
    ++stamp_;
    moment.is_of_camera = same_camera(moment.rays, target_.rays);
    moment.placed.resize(moment.pieces.size());
    for (std::size_t i = first; i < moment.pieces.size(); ++i) {
        Piece const& piece = moment.pieces[i];
        if (i > first && piece.scene_time != moment.pieces[i - 1].scene_time) {
            ++stamp_; // bodies were elsewhere
        }
        moment.placed[i] = {};
        TurnedBody const& turned = turn_to(moment, piece, motions);
        Vec3 parallax = turned.parallax;
        if (piece.velocity != Vec3(0)) {
            Vec3 const drift = static_cast<float>(target_.scene_time - piece.scene_time) * piece.velocity;
            parallax += drift.x * turned.carried[0] + drift.y * turned.carried[1] + drift.z * turned.carried[2];
        }
        Vec3 const at = turned.far * Vec3(piece.centre, 1) + piece.inverse_depth * parallax;
        if (!(at.z > nearest)) {
            continue;
        }
        float const inverse_z = 1 / at.z;
        float const scale = std::min(turned.lens * inverse_z, most_scale);
        moment.placed[i] = {inverse_z * Vec2(at), inverse_z * piece.inverse_depth, std::max(scale, 1 / most_scale),
                            false};
        splat(moment, i);
    }
}

void Mirror::splat(Moment& moment, std::size_t index) {
    Piece const& piece = moment.pieces[index];
    Placed& placed = moment.placed[index];
    float const scale = placed.scale;
    Vec2 const half = glm::min(widening * scale * piece.half_side + margin, Vec2(most_pixels));
    Vec2 const low = placed.at - half - 0.5f;
    Vec2 const high = placed.at + half + 0.5f;
    auto const width = static_cast<float>(columns_ * cell_side); // the last cells are whole, too
    auto const height = static_cast<float>(rows_ * cell_side);
    if (!(low.x <= width - 1 && low.y <= height - 1 && high.x >= 1 && high.y >= 1 && low.x > -most_pixels &&
          low.y > -most_pixels && high.x < most_pixels && high.y < most_pixels)) {
        placed.inverse_depth = -1;
        return;
    }
    // Pixels whose centres it covers.
    int const left = static_cast<int>(std::ceil(std::max(low.x, 0.0f)));
    int const top = static_cast<int>(std::ceil(std::max(low.y, 0.0f)));
    int const right = static_cast<int>(std::min(high.x, width));
    int const bottom = static_cast<int>(std::min(high.y, height));
    auto const age = static_cast<float>(target_.scene_time - piece.scene_time);
    float const worn = worn_spacing(scale * piece.spacing, age, piece.fading);
    float const w = placed.inverse_depth;
    auto const slot = static_cast<std::uint8_t>(&moment - moments_.data());
    for (int row = top / cell_side; row * cell_side < bottom; ++row) {
        unsigned const down = spread_rows(bits_between(top - row * cell_side, bottom - row * cell_side));
        for (int column = left / cell_side; column * cell_side < right; ++column) {
            unsigned const mask = down * bits_between(left - column * cell_side, right - column * cell_side);
            Cell& cell = cells_[index_of(column, row)];
            cell.covered = static_cast<std::uint16_t>(cell.covered | mask);
            int const share = std::popcount(mask);
            bool shows = false;
            if (share < least_share || cell.share < least_share) {
                shows = share > cell.share;
            } else if (w > cell.inverse_depth) {
                shows = w * (1 - surface_tolerance) > cell.inverse_depth || worn < cell.worn;
            } else {
                shows = w >= cell.inverse_depth * (1 - surface_tolerance) && worn < cell.worn;
            }
            if (shows) {
                cell.inverse_depth = w;
                cell.worn = worn;
                cell.detail = piece.detail / scale;
                cell.piece = static_cast<std::uint32_t>(index);
                cell.moment = slot;
                cell.share = static_cast<std::uint8_t>(share);
            }
        }
    }
}

/// What shows, and what does not though nothing hides it.
void Mirror::count_shown() {
    for (Moment& moment : moments_) {
        moment.shown = 0;
    }
    for (Cell const& cell : cells_) {
        if (cell.is_shown()) {
            ++moments_[cell.moment].shown;
            moments_[cell.moment].placed[cell.piece].shows = true;
        }
    }
    for (Moment& moment : moments_) {
        for (std::size_t i = 0; i < moment.pieces.size(); ++i) {
            Piece& piece = moment.pieces[i];
            piece.unshown =
                moment.placed[i].shows ? std::uint8_t{0} : static_cast<std::uint8_t>(std::min(piece.unshown + 1, 254));
        }
    }
}

} // namespace framelet
