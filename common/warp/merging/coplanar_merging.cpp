#include "common/warp/merging/coplanar_merging.h"

#include "common/morton.h"

namespace framelet {

namespace {

using Lanes = WideDoubles;
using Floats = float __attribute__((vector_size(4 * wide_doubles)));
using Ints = std::int32_t __attribute__((vector_size(4 * wide_doubles)));
using Piece = PieceLanes;

/// Share by which inverse depths may differ and still be the same for all that looks at them.
constexpr double one_surface = 2e-3;

/// A piece whose middle is off by more than this many times that is not worth a fit.
constexpr double hopeless = 2;

/// Number of times that near pieces prove not to be of the plane after which no more are looked for.
constexpr int most_failures = 2;

/// A bit for each framelet of the first quad, by index (as in `SquareLayers`).
constexpr std::uint64_t quarters = 0x0001000100010001u;

/// Cost of showing what lies in a rectangle, in pixels: blocks and lanes reach beyond it.
template <class Number>
Number showing_cost(Number half_width, Number half_height) {
    return (2 * half_width + 12) * (2 * half_height + 6);
}
template <class Number>
Number showing_cost(ExtentOf<Number> const& extent) {
    return (extent.right - extent.left + 12) * (extent.bottom - extent.top + 6);
}

Lanes doubles_of(Floats values) {
    return __builtin_convertvector(values, Lanes);
}
Lanes doubles_of(Ints values) {
    return __builtin_convertvector(values, Lanes);
}
Lanes all_of(double value) {
    return Lanes{} + value;
}
AffineOf<Lanes> all_of(AffinePlane const& plane) {
    return {all_of(plane.at), all_of(plane.dx), all_of(plane.dy)};
}
ExtentOf<Lanes> all_of(PlaneExtent const& extent) {
    return {all_of(extent.left), all_of(extent.top), all_of(extent.right), all_of(extent.bottom)};
}

/// Columns or rows of framelets in the square, by index.
constexpr auto coordinates(std::uint32_t (*coordinate)(std::uint32_t)) {
    std::array<float, SquareLayers::most_framelets> out{};
    for (std::size_t index = 0; index < out.size(); ++index) {
        out[index] = static_cast<float>(coordinate(static_cast<std::uint32_t>(SquareLayers::part_at(index))));
    }
    return out;
}
constexpr auto columns = coordinates(morton_x);
constexpr auto rows = coordinates(morton_y);

/// Byte `i` of each box, which is signed.
Lanes byte_of(Ints boxes, int i) {
    return doubles_of(boxes << (24 - 8 * i) >> 24);
}

/// The difference from a fit as a share of the fit's least inverse depth in a piece.
Lanes share_of(Lanes difference, AffineOf<Lanes> const& fit, Piece const& piece) {
    return difference == 0 ? Lanes{} : difference / least_value(fit, piece);
}

/// Difference of the planes of two pieces in the middle of `at`.
template <class Number>
Number difference_in_middle(PieceOf<Number> const& of, PieceOf<Number> const& at) {
    return absolute(of.value + of.dx * (at.x - of.x) + of.dy * (at.y - of.y) - at.value);
}

} // namespace

/// Merges framelets of one layer each first, four at a time; then whatever there is.
void CoplanarMerging::merge(SquareLayers const& layers, SampleGrid const& grid) {
    coplanar_.clear();
    quads_.clear();
    open_count_ = 0;
    std::uint64_t several = 0;
    for (std::size_t k = 1; k < max_layers; ++k) {
        several |= layers.rows(k).held;
    }
    std::uint64_t const one = layers.rows(0).held & ~several;
    std::uint64_t left = layers.rows(0).held;
    load(layers, 0, grid);
    left &= ~merge_quads(one & one >> 16 & one >> 32 & one >> 48 & 0xffffu);
    quad_count_ = open_count_;
    for (std::size_t i = 0; i < quad_count_; ++i) {
        PlanePiece const own = open_.piece(i);
        quads_.push_back({own.plane(), own.extent(), difference_[i], {quarters << index_[i]}});
    }
    for (std::size_t k = 0; k < max_layers; ++k) {
        if (k > 0) {
            left = layers.rows(k).held;
            load(layers, k, grid);
        }
        for (; left != 0; left &= left - 1) {
            auto const index = static_cast<std::size_t>(std::countr_zero(left));
            open_.copy(loaded_, index, open_count_);
            open(0, 0, index, k);
        }
    }
    for (Bits open = Bits::first(open_count_); open.any();) {
        Group const group = grow(open.lowest(), open);
        open = open.without(group.members);
        coplanar_.push_back(layer_of(group));
    }
}

/// Loads one layer of each framelet into rows of pieces.
void CoplanarMerging::load(SquareLayers const& layers, std::size_t layer, SampleGrid const& grid) {
    SquareLayers::Rows const& from = layers.rows(layer);
    double const tile = grid.side * grid.spacing; // pixels
    for (std::size_t i = 0; i < SquareLayers::most_framelets; i += wide_doubles) {
        if ((from.held >> i & ((1u << wide_doubles) - 1)) == 0) {
            continue;
        }
        Ints const box = load_lanes<Ints>(&from.box[i]);
        Lanes const left = byte_of(box, 0), top = byte_of(box, 1);
        Lanes const right = byte_of(box, 2) + 1, bottom = byte_of(box, 3) + 1;
        Lanes const x = 0.5 * grid.spacing * (left + right); // from the tile's corner on
        Lanes const y = 0.5 * grid.spacing * (top + bottom);
        Lanes const dx = doubles_of(load_lanes<Floats>(&from.dx[i]));
        Lanes const dy = doubles_of(load_lanes<Floats>(&from.dy[i]));
        Piece const piece{tile * doubles_of(load_lanes<Floats>(&columns[i])) + x,
                          tile * doubles_of(load_lanes<Floats>(&rows[i])) + y,
                          0.5 * grid.spacing * (right - left),
                          0.5 * grid.spacing * (bottom - top),
                          doubles_of(load_lanes<Floats>(&from.at[i])) + dx * x + dy * y,
                          dx,
                          dy};
        loaded_.store(piece, doubles_of(load_lanes<Ints>(&from.motion[i])), i);
    }
}

/// Merges the loaded layers of those quads that are `complete`, a lane for each quad. Returns a bit for each framelet
/// of those quads that one plane is near enough to; these quads are open then.
std::uint64_t CoplanarMerging::merge_quads(std::uint64_t complete) {
    std::uint64_t out = 0;
    for (std::size_t first = 0; first < SquareLayers::most_quads; first += wide_doubles) {
        unsigned const wanted = static_cast<unsigned>(complete >> first) & ((1u << wide_doubles) - 1);
        if (wanted == 0) {
            continue;
        }
        std::array<Piece, 4> parts;
        SumsOf<Lanes> sums;
        Lanes cost_of_parts{};
        Lanes const motion = loaded_.load_motion(first);
        WideLongs is_one = lanes_of(wanted);
        for (std::size_t k = 0; k < parts.size(); ++k) {
            std::size_t const i = SquareLayers::most_quads * k + first;
            parts[k] = loaded_.load(i);
            sums += sums_over(parts[k]);
            cost_of_parts += showing_cost(parts[k].half_width, parts[k].half_height);
            is_one &= loaded_.load_motion(i) == motion;
        }
        AffineOf<Lanes> const plane = fit_plane(sums);
        Lanes difference{}, share{};
        ExtentOf<Lanes> extent = parts[0].extent();
        for (Piece const& part : parts) {
            Lanes const own = largest_difference(part, plane);
            Lanes const own_share = share_of(own, plane, part);
            is_one &= (difference_in_middle(parts[0], part) <= hopeless * one_surface * part.value) & (own_share >= 0) &
                      (own_share <= one_surface);
            difference = larger(difference, own);
            share = larger(share, own_share);
            extent = united(extent, part.extent());
        }
        is_one &= showing_cost(extent) <= cost_of_parts;
        unsigned const found = bits_of(is_one);
        out |= std::uint64_t{found} << first;
        // All of them are stored; then those that one plane is near enough to are opened.
        PieceRows<wide_doubles> quads;
        quads.store(piece_of(plane, extent), motion, 0);
        std::array<double, wide_doubles> shares, differences;
        store_lanes(share, shares.data());
        store_lanes(difference, differences.data());
        for (unsigned left = found; left != 0; left &= left - 1) {
            auto const lane = static_cast<std::size_t>(std::countr_zero(left));
            open_.copy(quads, lane, open_count_);
            open(shares[lane], differences[lane], first + lane, 0);
        }
    }
    return out * quarters;
}

/// Opens the piece that was last copied to the rows.
void CoplanarMerging::open(double share, double difference, std::size_t index, std::size_t layer) {
    share_[open_count_] = share;
    difference_[open_count_] = difference;
    index_[open_count_] = static_cast<std::uint8_t>(index);
    layer_[open_count_] = static_cast<std::uint8_t>(layer);
    ++open_count_;
}

CoplanarMerging::Group CoplanarMerging::alone(std::size_t seed) const {
    PlanePiece const own = open_.piece(seed);
    double const cost = showing_cost(own.half_width, own.half_height);
    return {Bits::only(seed), sums_over(own), own.plane(), own.extent(), difference_[seed], cost, cost};
}

/// The group that can be merged around the piece `seed` from the `open` ones: tries all that may be of its plane at
/// once, else those that are near, and near to these, and then all once more. (Around a single layer too few of the far
/// ones are of its plane to begin with all.)
CoplanarMerging::Group CoplanarMerging::grow(std::size_t seed, Bits const& open) const {
    Group group = alone(seed);
    Bits rest = open.without(group.members);
    bool near = seed >= quad_count_;
    bool has_grown = false; // since all were tried last
    for (int failures = 0; failures < most_failures && rest.any();) {
        Bits const some = find(seed, group, rest, near);
        if (near && !some.any() && has_grown) {
            near = has_grown = false;
        } else if (!some.any()) {
            break;
        } else if (extend(some, near, group, rest)) {
            has_grown = near;
            near = true;
        } else {
            failures += near ? 1 : 0;
            near = true;
        }
    }
    return group;
}

/// Adds `some` to the group, or those of them that agree, or the first one of those that are `near`; true where any
/// were added. Pieces that are merged, or near and not of the plane, leave `rest`.
bool CoplanarMerging::extend(Bits some, bool near, Group& group, Bits& rest) const {
    for (int i = 0; i < 3 && some.any(); ++i) {
        Group extended = group;
        add(some, extended);
        if (extended.cost <= extended.cost_of_parts) {
            Bits const agreeing = fit(extended);
            if (agreeing == extended.members) {
                group = extended;
                group.cost_of_parts = group.cost;
                rest = rest.without(group.members);
                return true;
            }
            if ((some & agreeing) == some) { // the members that the group had before do not agree
                break;
            }
            rest = near ? rest.without(some.without(agreeing)) : rest;
            some = some & agreeing;
        } else if (near && !(some == Bits::only(some.lowest()))) {
            some = Bits::only(some.lowest());
        } else {
            break;
        }
    }
    rest = near ? rest.without(some) : rest;
    return false;
}

/// The `open` pieces that are of the seed's motion and may be of the group's plane; with `near` only those with each of
/// which alone the group would be cheaper to show.
CoplanarMerging::Bits CoplanarMerging::find(std::size_t seed, Group const& group, Bits const& open, bool near) const {
    Bits out;
    AffineOf<Lanes> const plane = all_of(group.plane);
    ExtentOf<Lanes> const extent = all_of(group.extent);
    PlanePiece const own = open_.piece(seed);
    Piece const in_lanes{all_of(own.x), all_of(own.y), {}, {}, all_of(own.value), all_of(own.dx), all_of(own.dy)};
    Lanes const off = all_of(hopeless * one_surface * own.value);
    for (std::size_t i = 0; i < open_count_; i += wide_doubles) {
        unsigned const wanted = open.lanes(i);
        if (wanted == 0) {
            continue;
        }
        Piece const other = open_.load(i);
        WideLongs is = (open_.load_motion(i) == open_.motion[seed]) &
                       (absolute(plane(other.x, other.y) - other.value) <= hopeless * one_surface * other.value) &
                       (difference_in_middle(other, in_lanes) <= off);
        if (near) {
            is &= showing_cost(united(extent, other.extent())) <=
                  group.cost + showing_cost(other.half_width, other.half_height);
        }
        out.add_lanes(i, bits_of(is) & wanted);
    }
    return out;
}

/// Adds pieces to the group without the fit, which is not needed where all together cost more.
void CoplanarMerging::add(Bits const& added, Group& group) const {
    constexpr double far = 1e30;
    ExtentOf<Lanes> const nothing{all_of(far), all_of(far), all_of(-far), all_of(-far)};
    ExtentOf<Lanes> extent = nothing;
    SumsOf<Lanes> sums;
    Lanes cost{};
    for (std::size_t i = 0; i < open_count_; i += wide_doubles) {
        unsigned const wanted = added.lanes(i);
        if (wanted == 0) {
            continue;
        }
        WideLongs const is = lanes_of(wanted);
        Piece const piece = open_.load(i, is);
        ExtentOf<Lanes> const own = piece.extent();
        extent = united(extent, {is ? own.left : nothing.left, is ? own.top : nothing.top,
                                 is ? own.right : nothing.right, is ? own.bottom : nothing.bottom});
        cost += is ? showing_cost(piece.half_width, piece.half_height) : Lanes{};
        sums += sums_over(piece);
    }
    group.members = group.members | added;
    group.extent = united(group.extent, {smallest_of(extent.left), smallest_of(extent.top), largest_of(extent.right),
                                         largest_of(extent.bottom)});
    group.cost = showing_cost(group.extent);
    group.cost_of_parts += sum_of(cost);
    if (group.cost <= group.cost_of_parts) {
        group.sums +=
            {sum_of(sums.area), sum_of(sums.x),     sum_of(sums.y),       sum_of(sums.xx),     sum_of(sums.xy),
             sum_of(sums.yy),   sum_of(sums.value), sum_of(sums.value_x), sum_of(sums.value_y)};
    }
}

/// Fits the group's plane. Returns those members that it is near enough to.
CoplanarMerging::Bits CoplanarMerging::fit(Group& group) const {
    group.plane = fit_plane(group.sums);
    AffineOf<Lanes> const plane = all_of(group.plane);
    Lanes difference{};
    Bits out;
    for (std::size_t i = 0; i < open_count_; i += wide_doubles) {
        unsigned const wanted = group.members.lanes(i);
        if (wanted == 0) {
            continue;
        }
        Piece const piece = open_.load(i);
        Lanes const own = largest_difference(piece, plane);
        Lanes const share = one_surface - load_lanes<Lanes>(&share_[i]); // the share that is left
        out.add_lanes(i, bits_of(own <= share * least_value(plane, piece)) & wanted);
        difference = lanes_of(wanted) ? larger(own + load_lanes<Lanes>(&difference_[i]), difference) : difference;
    }
    group.difference = largest_of(difference);
    return out;
}

CoplanarLayers CoplanarMerging::layer_of(Group const& group) const {
    CoplanarLayers out{group.plane, group.extent, group.difference, {}};
    group.members.for_each(
        [&](std::size_t i) { out.parts[layer_[i]] |= (i < quad_count_ ? quarters : std::uint64_t{1}) << index_[i]; });
    return out;
}

} // namespace framelet
