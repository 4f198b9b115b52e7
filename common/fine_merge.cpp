#include "common/fine_merge.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

namespace framelet {

namespace {

/// Samples copied at a time; the side of a child is a multiple of it.
constexpr int run = framelet_side >> finest_levels;

double value_at(Layer const& layer, double x, double y) {
    return layer.at + layer.dx * x + layer.dy * y;
}

/// Where parts of so many levels begin among all parts: 1 + 4 + ... before them.
constexpr std::size_t first_part(int levels) {
    return ((std::size_t{1} << 2 * levels) - 1) / 3;
}

} // namespace

void FineSquare::update(FrameletCache const& cache, Tile square, int depth) {
    square_ = square;
    depth_ = depth;
    bool changed = false;
    for (std::uint32_t block = 0; block < blocks; ++block) {
        Tile const tile = square.child(block);
        std::uint64_t const version =
            cache.block_version(static_cast<int>(tile.column()), static_cast<int>(tile.row()));
        if (version != versions_[block]) {
            versions_[block] = version;
            load(cache, block);
            changed = true;
        }
    }
    if (changed) {
        for (Part& part : parts_) {
            part.state = State::unknown;
        }
    }
}

void FineSquare::load(FrameletCache const& cache, std::uint32_t block) {
    int const levels = depth_ - square_.depth();
    std::uint32_t const count = 1u << 2 * levels;
    std::uint32_t const first = block * (count / blocks);
    for (std::uint32_t i = first; i < first + count / blocks; ++i) {
        Tile const tile{(square_.code << 2 * levels) + i};
        int const column = static_cast<int>(tile.column());
        int const row = static_cast<int>(tile.row());
        std::uint64_t const version = cache.version_of(depth_, column, row);
        if (version > 0 && children_.empty()) {
            children_.resize(count);
            parts_.resize(first_part(levels));
            grid_.resize(static_cast<std::size_t>(side * side));
            pixels_ = cache.plane().tile_side(tile);
        }
        if (children_.empty() || version == children_[i].version) {
            continue;
        }
        CachedFramelet const* const found = cache.find(depth_, column, row);
        bool const is_usable = found != nullptr && found->shape.layer_count == 1 && found->shape.loose.empty();
        Child& child = children_[i];
        child.version = version;
        usable_ -= child.is_usable ? 1 : 0;
        child.is_usable = is_usable;
        if (is_usable) {
            ++usable_;
            child.view = found->view;
            child.batch = found->moment.batch;
            child.layer = found->shape.layers[0].layer;
            copy(*found, i);
        }
    }
}

void FineSquare::copy(CachedFramelet const& framelet, std::uint32_t index) {
    int const n = framelet.shape.side;
    PackedSample const* from = n == framelet_side ? framelet.samples.data() : framelet.shape.reduced.data();
    PackedSample* to = grid_.data() + morton_y(index) * static_cast<std::uint32_t>(n * side) +
                       morton_x(index) * static_cast<std::uint32_t>(n);
    for (int y = 0; y < n; ++y, from += n, to += side) {
        for (int x = 0; x < n; x += run) {
            std::memcpy(to + x, from + x, run * sizeof(PackedSample));
        }
    }
}

MergedFramelet const* FineSquare::merged(int levels, std::uint32_t index) {
    if (usable_ == 0) {
        return nullptr;
    }
    Part& part = parts_[first_part(levels) + index];
    if (part.state == State::unknown) {
        part.state = make(levels, index, part.merged) ? State::present : State::absent;
    }
    return part.state == State::present ? &part.merged : nullptr;
}

/// The plane is the least-squares fit to the inverse depths in the middles of the children, its difference is taken at
/// the corners of their tiles.
bool FineSquare::make(int levels, std::uint32_t index, MergedFramelet& merged) const {
    auto const count = static_cast<std::uint32_t>(children_.size()) >> 2 * levels;
    std::span const children(children_.data() + index * count, count);
    Child const& first = children[0];
    if (!std::ranges::all_of(children, [&](Child const& child) {
            return child.is_usable && child.view == first.view && child.layer.body == first.layer.body &&
                   child.layer.velocity == first.layer.velocity;
        })) {
        return false;
    }
    int const n = 1 << (depth_ - square_.depth() - levels); // children along a side
    double const middle = 0.5 * (n - 1);
    double mean = 0, dx = 0, dy = 0, squares = 0;
    merged.newest_batch = 0;
    merged.signature = 0;
    Layer& plane = merged.layer.layer;
    plane = first.layer;
    for (std::uint32_t i = 0; i < count; ++i) {
        Child const& child = children[i];
        double const value = value_at(child.layer, 0.5 * pixels_, 0.5 * pixels_);
        double const x = morton_x(i) - middle;
        mean += value / count;
        dx += value * x;
        dy += value * (morton_y(i) - middle);
        squares += x * x;
        plane.error = std::max(plane.error, child.layer.error);
        merged.newest_batch = std::max(merged.newest_batch, child.batch);
        merged.signature = (merged.signature + child.batch) * 0x9e3779b97f4a7c15u;
    }
    dx /= squares * pixels_;
    dy /= squares * pixels_;
    plane.at = static_cast<float>(mean - (dx + dy) * 0.5 * n * pixels_);
    plane.dx = static_cast<float>(dx);
    plane.dy = static_cast<float>(dy);
    double difference = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        for (std::uint32_t corner = 0; corner < 4; ++corner) {
            double const x = corner % 2 * pixels_;
            double const y = corner / 2 * pixels_;
            double const own = value_at(children[i].layer, x, y);
            double const fitted = value_at(plane, morton_x(i) * pixels_ + x, morton_y(i) * pixels_ + y);
            difference = std::max(difference, std::abs(own - fitted));
        }
    }
    merged.difference = static_cast<float>(difference);
    plane.error += merged.difference;
    merged.tile = {(square_.code << 2 * levels) + index};
    merged.first = {(merged.tile.code << 2 * (depth_ - merged.tile.depth()))};
    merged.view = first.view;
    merged.side = side >> levels;
    merged.stride = side;
    merged.layer.first_column = merged.layer.first_row = 0;
    merged.layer.last_column = merged.layer.last_row = static_cast<std::int8_t>(merged.side - 1);
    merged.grid = grid_.data() + morton_y(index) * static_cast<std::uint32_t>(merged.side * side) +
                  morton_x(index) * static_cast<std::uint32_t>(merged.side);
    return true;
}

} // namespace framelet
