#include "common/layer_joining.h"

#include <algorithm>
#include <utility>

#include "common/lanes.h"

namespace framelet {

namespace {

/// A number of each of four layers.
using Four = FourDoubles;
using FourLayers = std::array<JoinedLayer const*, 4>;

template <class Number>
Four each_of(FourLayers const& layers, Number const& number) {
    return Four{number(*layers[0]), number(*layers[1]), number(*layers[2]), number(*layers[3])};
}

AffineOf<Four> planes_of(FourLayers const& layers) {
    return {each_of(layers, [](JoinedLayer const& layer) { return layer.plane.at; }),
            each_of(layers, [](JoinedLayer const& layer) { return layer.plane.dx; }),
            each_of(layers, [](JoinedLayer const& layer) { return layer.plane.dy; })};
}

ExtentOf<Four> extents_of(FourLayers const& layers) {
    return {each_of(layers, [](JoinedLayer const& layer) { return layer.extent.left; }),
            each_of(layers, [](JoinedLayer const& layer) { return layer.extent.top; }),
            each_of(layers, [](JoinedLayer const& layer) { return layer.extent.right; }),
            each_of(layers, [](JoinedLayer const& layer) { return layer.extent.bottom; })};
}

double smallest_of(Four values) {
    return smaller(smaller(values[0], values[1]), smaller(values[2], values[3]));
}

double largest_of(Four values) {
    return larger(larger(values[0], values[1]), larger(values[2], values[3]));
}

std::uint64_t combine(std::uint64_t signature, std::uint64_t part) {
    return (signature + part) * 0x9e3779b97f4a7c15u;
}

std::uint64_t signature_of(std::uint64_t batch, std::uint8_t number) {
    return batch * 256 + number;
}

} // namespace

LayerJoining::LayerJoining() : layers_(most_layers), open_(std::make_unique<Open>()), next_(std::make_unique<Open>()) {}

void LayerJoining::start(int levels, SampleGrid const& grid) {
    levels_ = levels;
    grid_ = grid;
    leaves_.clear();
    motions_.clear();
    layer_count_ = 0;
}

void LayerJoining::add(HeldLayer const& held, std::uint64_t batch, std::uint32_t view, std::uint32_t part,
                       std::uint32_t layer) {
    FrameletLayer& leaf = leaves_.emplace_back();
    leaf.held = &held;
    leaf.batch = batch;
    leaf.view = view;
    leaf.part = static_cast<std::uint8_t>(part);
    leaf.layer = static_cast<std::uint8_t>(layer);
    leaf.motion = motion_of(leaf);
    fours_.set(part, held);
    JoinedLayer& out = layers_[layer_count_++];
    out.parts.fill(JoinedLayer::no_part);
    out.levels = static_cast<std::uint8_t>(levels_);
    out.part = leaf.part;
    out.number = number_of(part, layer);
    out.is_joined_further = false;
}

double LayerJoining::motion_of(FrameletLayer const& layer) {
    // Mostly that of the layer before.
    for (std::size_t i = motions_.size(); i-- > 0;) {
        FrameletLayer const& known = leaves_[static_cast<std::size_t>(motions_[i])];
        if (known.view == layer.view && known.held->layer.body == layer.held->layer.body &&
            known.held->layer.velocity == layer.held->layer.velocity) {
            return static_cast<double>(i);
        }
    }
    motions_.push_back(static_cast<std::int16_t>(leaves_.size() - 1));
    return static_cast<double>(motions_.size() - 1);
}

void LayerJoining::finish() {
    join_framelets();
    for (int levels = levels_ - 2; levels >= 0; --levels) {
        next_->clear();
        for (std::size_t first = 0, last = 0; first < open_->count; first = last) {
            while (last < open_->count && part_at(last, levels) == part_at(first, levels)) {
                ++last;
            }
            join_part(first, last, levels);
        }
        std::swap(open_, next_);
    }
}

/// Within four of them: all fours of framelets of one layer each are tried at once.
void LayerJoining::join_framelets() {
    next_->clear();
    fours_.join(levels_ > 0 ? std::size_t{1} << 2 * (levels_ - 1) : 0, grid_);
    for (std::size_t first = 0, last = 0; first < leaves_.size(); first = last) {
        int const four = leaves_[first].part / 4;
        while (last < leaves_.size() && leaves_[last].part / 4 == four) {
            ++last;
        }
        if (levels_ > 0 && is_four(first, last) && fours_.is_joined(static_cast<std::size_t>(four))) {
            keep_four(first);
            continue;
        }
        Open& open = levels_ > 0 ? *open_ : *next_;
        open.clear();
        for (std::size_t i = first; i < last; ++i) {
            complete(i);
            open.add(i, leaves_[i].motion, leaves_[i].part, layers_[i].plane, layers_[i].extent);
        }
        if (levels_ > 0) {
            join_part(0, open.count, levels_ - 1);
        }
    }
    std::swap(open_, next_);
}

/// One layer of each of four framelets that share a parent, all of one view, body and velocity.
bool LayerJoining::is_four(std::size_t first, std::size_t last) const {
    if (last - first != 4) {
        return false;
    }
    bool is = true;
    for (std::size_t k = 0; k < 4; ++k) {
        is &= leaves_[first + k].part % 4 == k && leaves_[first + k].motion == leaves_[first].motion;
    }
    return is;
}

void LayerJoining::keep_four(std::size_t first) {
    FrameletLayer const& leaf = leaves_[first];
    std::size_t const four = leaf.part / 4;
    JoinedLayer& joined = layers_[layer_count_];
    joined.plane = fours_.plane(four);
    joined.share = fours_.share(four);
    joined.extent = fours_.extent(four);
    next_->add(layer_count_++, leaf.motion, leaf.part, joined.plane, joined.extent);
    joined.sums = fours_.sums(four);
    joined.difference = fours_.difference(four);
    joined.newest_batch = 0;
    joined.signature = 0;
    joined.error = leaf.held->layer.error; // also where that is not a number
    joined.view = leaf.view;
    joined.velocity = leaf.held->layer.velocity;
    joined.body = leaf.held->layer.body;
    joined.levels = static_cast<std::uint8_t>(levels_ - 1);
    joined.part = static_cast<std::uint8_t>(four);
    joined.number = number_of(leaf.part, leaf.layer);
    joined.is_joined_further = false;
    for (std::size_t k = 0; k < 4; ++k) {
        FrameletLayer const& member = leaves_[first + k];
        joined.error = std::max(joined.error, member.held->layer.error);
        joined.newest_batch = std::max(joined.newest_batch, member.batch);
        joined.signature = combine(joined.signature, signature_of(member.batch, layers_[first + k].number));
        joined.parts[k] = static_cast<std::int16_t>(first + k);
        layers_[first + k].is_joined_further = true;
    }
}

/// What `add` leaves out.
void LayerJoining::complete(std::size_t leaf) {
    FrameletLayer const& from = leaves_[leaf];
    JoinedLayer& out = layers_[leaf];
    HeldLayer const& held = *from.held;
    double const column = morton_x(from.part);
    double const row = morton_y(from.part);
    double const left = grid_.side * column;
    double const top = grid_.side * row;
    out.plane = plane_in_square<double>(held.layer.at, held.layer.dx, held.layer.dy, column, row, grid_);
    out.share = 0;
    out.extent = {grid_.spacing * (left + held.first_column), grid_.spacing * (top + held.first_row),
                  grid_.spacing * (left + held.last_column + 1), grid_.spacing * (top + held.last_row + 1)};
    out.sums = sums_over(out.plane, out.extent);
    out.difference = 0;
    out.newest_batch = from.batch;
    out.signature = signature_of(from.batch, out.number);
    out.error = held.layer.error;
    out.view = from.view;
    out.velocity = held.layer.velocity;
    out.body = held.layer.body;
}

/// Greedily, in Morton order.
void LayerJoining::join_part(std::size_t first, std::size_t last, int levels) {
    Part part{levels, {first, first, first, first, last}};
    for (std::size_t i = first; i < last; ++i) {
        for (std::size_t k = part_at(i, levels + 1) % 4; k < 3; ++k) {
            part.quarters[k + 1] = i + 1;
        }
    }
    for (std::size_t i = first; i < last; ++i) {
        if (open_->motion[i] == Open::taken) {
            continue;
        }
        Group group = group_of(i, part, false);
        if (group.joined_cost > group.cost_of_parts) {
            group = group_of(i, part, true);
        }
        if (std::ranges::count(group.members, JoinedLayer::no_part) == 3) {
            next_->add(static_cast<std::size_t>(open_->layer[i]), open_->motion[i], open_->part[i], open_layer(i).plane,
                       open_layer(i).extent);
        } else {
            keep(group, i, levels);
        }
    }
}

void LayerJoining::keep(Group const& group, std::size_t seed, int levels) {
    JoinedLayer& joined = layers_[layer_count_];
    JoinedLayer const& first = open_layer(seed);
    joined = {};
    joined.plane = group.plane;
    joined.share = group.share;
    joined.extent = group.extent;
    joined.sums = group.sums;
    joined.difference = group.difference;
    joined.error = first.error; // also where that is not a number
    joined.view = first.view;
    joined.velocity = first.velocity;
    joined.body = first.body;
    joined.levels = static_cast<std::uint8_t>(levels);
    joined.part = static_cast<std::uint8_t>(part_at(seed, levels));
    joined.number = first.number;
    next_->add(layer_count_++, open_->motion[seed], open_->part[seed], joined.plane, joined.extent);
    for (std::size_t k = 0; k < group.members.size(); ++k) {
        if (group.members[k] == JoinedLayer::no_part) {
            continue;
        }
        auto const open = static_cast<std::size_t>(group.members[k]);
        open_->motion[open] = Open::taken;
        joined.parts[k] = open_->layer[open];
        JoinedLayer& member = layers_[static_cast<std::size_t>(open_->layer[open])];
        member.is_joined_further = true;
        joined.error = std::max(joined.error, member.error);
        joined.newest_batch = std::max(joined.newest_batch, member.newest_batch);
        joined.signature = combine(joined.signature, member.signature);
    }
}

/// What of a part can be joined to one that is open, at most one layer of each quarter: all at once where they are of
/// one plane, else one after the other. `cheaply`: only what is cheaper joined than alone is added.
LayerJoining::Group LayerJoining::group_of(std::size_t seed, Part const& part, bool cheaply) const {
    JoinedLayer const& own = open_layer(seed);
    std::size_t quarter = part_at(seed, part.levels + 1) % 4;
    Group group;
    group.members.fill(JoinedLayer::no_part);
    group.members[quarter] = static_cast<std::int16_t>(seed);
    std::size_t const last = part.quarters[4];
    Open::Bits some = candidates(part, seed, own.plane);
    std::size_t i = Open::next(some, part.quarters[quarter + 1], last);
    if (!cheaply && i < last) {
        std::size_t const tried = join_first_ones(seed, quarter, part, some, group);
        if (tried == 0) {
            return group;
        }
        i = tried == 2 ? Open::next(some, i + 1, last) : i; // two that were not of one plane will not be now
    }
    group.plane = own.plane;
    group.extent = own.extent;
    group.joined_cost = group.cost_of_parts = showing_cost(own.extent);
    while (i < last) {
        PlaneExtent const& extent = open_layer(i).extent;
        std::size_t const its_quarter = part_at(i, part.levels + 1) % 4;
        Members members = group.members;
        members[its_quarter] = static_cast<std::int16_t>(i);
        if ((!cheaply || showing_cost(united(group.extent, extent)) <= group.joined_cost + showing_cost(extent)) &&
            join(members, seed, group)) {
            some = candidates(part, seed, group.plane);
            i = Open::next(some, part.quarters[its_quarter + 1], last);
        } else {
            i = Open::next(some, i + 1, last);
        }
    }
    return group;
}

/// With the first candidate of each quarter. 0 where they are of one plane, else how many they are.
std::size_t LayerJoining::join_first_ones(std::size_t seed, std::size_t quarter, Part const& part,
                                          Open::Bits const& candidates, Group& group) const {
    Members members = group.members;
    std::size_t count = 1;
    for (std::size_t k = quarter + 1; k < members.size(); ++k) {
        std::size_t const i = Open::next(candidates, part.quarters[k], part.quarters[k + 1]);
        if (i < part.quarters[k + 1]) {
            members[k] = static_cast<std::int16_t>(i);
            ++count;
        }
    }
    return join(members, seed, group) ? 0 : count;
}

/// Of those that are open, bit by bit: what is of the seed's view, body and velocity and about of this plane.
LayerJoining::Open::Bits LayerJoining::candidates(Part const& part, std::size_t seed, AffinePlane const& plane) const {
    return open_->find(part.quarters[0], part.quarters[4], open_->motion[seed], plane, hopeless * one_surface);
}

/// Makes a group of these, of which the seed is one, if one plane is near enough to all of them.
bool LayerJoining::join(Members const& members, std::size_t seed, Group& group) const {
    static JoinedLayer const nothing{};
    FourLayers layers; // the seed stands for those that are not there
    PlaneSums sums;
    for (std::size_t k = 0; k < members.size(); ++k) {
        bool const is = members[k] != JoinedLayer::no_part;
        layers[k] = &open_layer(is ? static_cast<std::size_t>(members[k]) : seed);
        sums += (is ? layers[k] : &nothing)->sums;
    }
    AffinePlane const plane = fit_plane(sums);
    AffineOf<Four> const one{Four{} + plane.at, Four{} + plane.dx, Four{} + plane.dy};
    AffineOf<Four> const planes = planes_of(layers);
    ExtentOf<Four> const extents = extents_of(layers);
    Four const own = largest_difference(planes, one, extents);
    Four const own_share = own == 0 ? Four{} : own / least_value(one, extents);
    Four const share = each_of(layers, [](JoinedLayer const& layer) { return layer.share; }) + own_share;
    if (bits_of((own_share >= 0) & (share <= one_surface)) != 15) {
        return false;
    }
    group.members = members;
    group.plane = plane;
    group.sums = sums;
    group.extent = {smallest_of(extents.left), smallest_of(extents.top), largest_of(extents.right),
                    largest_of(extents.bottom)};
    group.difference = largest_of(each_of(layers, [](JoinedLayer const& layer) { return layer.difference; }) + own);
    group.share = largest_of(share);
    group.joined_cost = showing_cost(group.extent);
    group.cost_of_parts = 0;
    Four const costs = showing_cost(extents);
    for (std::size_t k = 0; k < members.size(); ++k) {
        group.cost_of_parts += members[k] == JoinedLayer::no_part ? 0 : costs[k];
    }
    return true;
}

} // namespace framelet
