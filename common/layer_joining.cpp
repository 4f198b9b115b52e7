#include "common/layer_joining.h"

#include <algorithm>
#include <span>

namespace framelet {

namespace {

/// A layer this many times the tolerance off, where it lies, is not worth a fit.
constexpr double hopeless = 4;

/// What it costs to show what lies there, in pixels: blocks and lanes reach beyond it.
double cost(PlaneExtent const& extent) {
    return (extent.right - extent.left + 12) * (extent.bottom - extent.top + 6);
}

std::uint32_t part_at(JoinedLayer const& layer, int levels) {
    return layer.part >> 2 * (layer.levels - levels);
}

bool may_join(JoinedLayer const& a, JoinedLayer const& b) {
    double const x = b.extent.middle_x();
    double const y = b.extent.middle_y();
    double const value = b.plane(x, y);
    return a.view == b.view && a.body == b.body && a.velocity == b.velocity &&
           std::abs(a.plane(x, y) - value) <= hopeless * one_surface * value;
}

SampleBox united(SampleBox const& a, SampleBox const& b) {
    return {std::min(a.first_column, b.first_column), std::min(a.first_row, b.first_row),
            std::max(a.last_column, b.last_column), std::max(a.last_row, b.last_row)};
}

PlaneExtent united(PlaneExtent const& a, PlaneExtent const& b) {
    return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}

} // namespace

void LayerJoining::start(int levels) {
    levels_ = levels;
    layers_.clear();
    open_.clear();
}

void LayerJoining::add(JoinedLayer const& layer) {
    open_.push_back(static_cast<std::int16_t>(layers_.size()));
    layers_.push_back(layer);
}

void LayerJoining::finish() {
    for (int levels = levels_ - 1; levels >= 0; --levels) {
        next_.clear();
        for (std::size_t first = 0, last = 0; first < open_.size(); first = last) {
            auto const part = [&](std::size_t i) {
                return part_at(layers_[static_cast<std::size_t>(open_[i])], levels);
            };
            while (last < open_.size() && part(last) == part(first)) {
                ++last;
            }
            join_part(first, last, levels);
        }
        open_.swap(next_);
    }
}

/// Greedily, in Morton order.
void LayerJoining::join_part(std::size_t first, std::size_t last, int levels) {
    for (std::size_t i = first; i < last; ++i) {
        std::int16_t const seed = open_[i];
        if (layers_[static_cast<std::size_t>(seed)].is_joined_further) {
            continue;
        }
        Group group = group_of(i, last, levels, false);
        if (group.joined_cost > group.cost_of_parts) {
            group = group_of(i, last, levels, true);
        }
        if (group.count == 1) {
            next_.push_back(seed);
            continue;
        }
        JoinedLayer& joined = group.layer;
        joined.part = part_at(joined, levels);
        joined.levels = levels;
        joined.signature = 0;
        for (std::int16_t const index : joined.parts) {
            if (index != JoinedLayer::no_part) {
                JoinedLayer& member = layers_[static_cast<std::size_t>(index)];
                member.is_joined_further = true;
                joined.signature = (joined.signature + member.signature) * 0x9e3779b97f4a7c15u;
            }
        }
        next_.push_back(static_cast<std::int16_t>(layers_.size()));
        layers_.push_back(joined);
    }
}

/// What of a part can be joined to one that is open, at most one layer of each quarter: all at once where they are of
/// one plane, else one after the other. `cheaply`: only what is cheaper joined than alone is added.
LayerJoining::Group LayerJoining::group_of(std::size_t first, std::size_t last, int levels, bool cheaply) const {
    JoinedLayer const& seed = layers_[static_cast<std::size_t>(open_[first])];
    std::uint32_t quarter = part_at(seed, levels + 1) % 4;
    Group group{seed, 1, cost(seed.extent), cost(seed.extent)};
    group.layer.parts.fill(JoinedLayer::no_part);
    group.layer.parts[quarter] = open_[first];
    if (!cheaply && join_first_ones(first, last, levels, group)) {
        return group;
    }
    for (std::size_t i = first + 1; i < last; ++i) {
        JoinedLayer const& other = layers_[static_cast<std::size_t>(open_[i])];
        std::uint32_t const its_quarter = part_at(other, levels + 1) % 4;
        if (its_quarter == quarter || other.is_joined_further || !may_join(group.layer, other)) {
            continue;
        }
        double const together = cost(united(group.layer.extent, other.extent));
        std::array<std::int16_t, 4> parts = group.layer.parts;
        parts[its_quarter] = open_[i];
        if ((!cheaply || together <= group.joined_cost + cost(other.extent)) && join(parts, group)) {
            quarter = its_quarter;
        }
    }
    return group;
}

/// With the first one of each quarter that may join.
bool LayerJoining::join_first_ones(std::size_t first, std::size_t last, int levels, Group& group) const {
    std::array<std::int16_t, 4> parts = group.layer.parts;
    for (std::size_t i = first + 1; i < last; ++i) {
        JoinedLayer const& other = layers_[static_cast<std::size_t>(open_[i])];
        std::int16_t& part = parts[part_at(other, levels + 1) % 4];
        if (part == JoinedLayer::no_part && !other.is_joined_further && may_join(group.layer, other)) {
            part = open_[i];
        }
    }
    return parts == group.layer.parts || join(parts, group);
}

/// Makes a group of these, if one plane is near enough to all of them.
bool LayerJoining::join(std::array<std::int16_t, 4> const& parts, Group& group) const {
    std::array<JoinedLayer const*, 4> members;
    std::size_t count = 0;
    PlaneSums sums;
    for (std::int16_t const part : parts) {
        if (part != JoinedLayer::no_part) {
            members[count++] = &layers_[static_cast<std::size_t>(part)];
            sums += members[count - 1]->sums;
        }
    }
    AffinePlane const plane = fit_plane(sums);
    double difference = 0;
    double share = 0;
    for (JoinedLayer const* const member : std::span(members).first(count)) {
        double const own = largest_difference(member->plane, plane, member->extent);
        double const own_share = own == 0 ? 0 : own / least_value(plane, member->extent);
        if (!(own_share >= 0 && member->share + own_share <= one_surface)) {
            return false;
        }
        difference = std::max(difference, member->difference + own);
        share = std::max(share, member->share + own_share);
    }
    JoinedLayer& layer = group.layer;
    group.count = static_cast<int>(count);
    group.cost_of_parts = 0;
    for (JoinedLayer const* const member : std::span(members).first(count)) {
        layer.extent = united(layer.extent, member->extent);
        layer.box = united(layer.box, member->box);
        layer.error = std::max(layer.error, member->error);
        layer.newest_batch = std::max(layer.newest_batch, member->newest_batch);
        group.cost_of_parts += cost(member->extent);
    }
    layer.plane = plane;
    layer.sums = sums;
    layer.parts = parts;
    layer.difference = difference;
    layer.share = share;
    group.joined_cost = cost(layer.extent);
    return true;
}

} // namespace framelet
