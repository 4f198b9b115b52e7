#include "common/merged_square.h"

#include <algorithm>
#include <bit>
#include <span>

#include "common/lanes.h"

namespace framelet {

namespace {

constexpr std::uint32_t no_number = 255; ///< of samples that are on no layer

static_assert(MergedSquare::most_children * max_layers <= no_number);

/// The moving grid, of so many samples along a side.
PackedSample const* samples_of(CachedFramelet const& framelet, int side) {
    return side == framelet_side ? framelet.samples.data() : framelet.shape.reduced.data();
}

Tile tile_below(Tile tile, int levels, std::uint32_t part) {
    return {(tile.code << 2 * levels) + part};
}

} // namespace

void MergedSquare::update(FrameletCache const& cache, Tile square, int depth, LayerJoining& joining) {
    square_ = square;
    depth_ = depth;
    SquareVersions const& versions = cache.versions(depth, square.column(), square.row());
    if (versions.newest == versions_.newest) {
        return;
    }
    std::uint64_t const changed = changes(versions);
    versions_ = versions;
    if (changed != 0) {
        load(cache, changed);
        join(joining);
    }
}

/// A bit for each tile below the square where something else is held than before.
std::uint64_t MergedSquare::changes(SquareVersions const& versions) {
    std::uint64_t out = 0;
    for (std::size_t i = 0; i < most_children; ++i) {
        out |= std::uint64_t{versions.tiles[i] != versions_.tiles[i]} << i;
    }
    return out;
}

/// What is far away in memory is fetched before it is looked at.
void MergedSquare::load(FrameletCache const& cache, std::uint64_t changed) {
    if (children_.empty()) {
        make_room(cache.plane());
    }
    for (std::uint64_t left = changed; left != 0; left &= left - 1) {
        auto const i = static_cast<std::uint32_t>(std::countr_zero(left));
        Tile const tile = tile_below(square_, levels(), i);
        CachedFramelet const* const framelet =
            cache.find(depth_, static_cast<int>(tile.column()), static_cast<int>(tile.row()));
        children_[i] = {};
        children_[i].framelet = framelet;
        if (framelet != nullptr) {
            __builtin_prefetch(framelet);
            __builtin_prefetch(&framelet->shape.layers);
            __builtin_prefetch(samples_of(*framelet, child_side_));
            for (int row = 0; row < child_side_; ++row) {
                __builtin_prefetch(place_of(i) + row * side_, 1);
            }
        }
    }
    for (std::uint64_t left = changed; left != 0; left &= left - 1) {
        copy_layers(static_cast<std::size_t>(std::countr_zero(left)));
    }
}

void MergedSquare::make_room(ImagePlane const& plane) {
    std::size_t const count = std::size_t{1} << 2 * levels();
    int const pixels = plane.tile_side(tile_below(square_, levels(), 0));
    child_side_ = std::min(framelet_side, pixels);
    side_ = child_side_ << levels();
    spacing_ = static_cast<double>(pixels) / child_side_;
    children_.resize(count);
    layers_.resize(count * max_layers);
    grid_.assign(static_cast<std::size_t>(side_ * side_), no_number << 24);
}

void MergedSquare::copy_layers(std::size_t index) {
    Child& child = children_[index];
    if (child.framelet == nullptr) {
        return;
    }
    HeldShape const& shape = child.framelet->shape;
    child.layer_count = shape.layer_count;
    child.has_loose = !shape.loose.empty();
    child.view = child.framelet->view;
    child.batch = child.framelet->moment.batch;
    for (std::size_t i = 0; i < shape.layer_count; ++i) {
        layer(index, i) = shape.layers[i];
    }
}

void MergedSquare::join(LayerJoining& joining) {
    joining.start(levels(), {child_side_, spacing_});
    for (std::uint32_t i = 0; i < children_.size(); ++i) {
        for (std::uint32_t k = 0; k < children_[i].layer_count; ++k) {
            HeldLayer const& held = layer(i, k);
            if (held.last_column >= held.first_column) {
                joining.add(held, children_[i].batch, children_[i].view, i, k);
            }
        }
    }
    joining.finish();
    keep(joining.layers());
}

/// What was joined comes after its parts.
void MergedSquare::keep(std::span<JoinedLayer const> layers) {
    merged_.clear();
    tops_.clear();
    std::array<std::array<std::uint8_t, max_layers>, most_children> numbers{};
    std::array<std::uint8_t, LayerJoining::most_layers> tops{};
    for (std::size_t i = layers.size(); i-- > 0;) {
        JoinedLayer const& joined = layers[i];
        std::uint8_t const top = joined.is_joined_further ? tops[i] : joined.number;
        bool const is_of_child = joined.levels == levels();
        if (is_of_child) {
            numbers[joined.part][joined.number % max_layers] = top;
        }
        if (is_of_child && joined.is_joined_further) {
            continue;
        }
        if (!joined.is_joined_further) {
            tops_.push_back(static_cast<std::uint16_t>(merged_.size()));
        }
        MergedLayer& merged = merged_.emplace_back();
        merge(joined, merged);
        merged.number = top;
        for (std::size_t k = 0; k < joined.parts.size(); ++k) {
            if (joined.parts[k] == JoinedLayer::no_part) {
                continue;
            }
            auto const index = static_cast<std::size_t>(joined.parts[k]);
            tops[index] = top;
            merged.parts[k] =
                layers[index].levels == levels()
                    ? MergedPart{MergedPart::Kind::layer, static_cast<std::uint8_t>(layers[index].number % max_layers),
                                 static_cast<std::uint16_t>(layers[index].part)}
                    : MergedPart{MergedPart::Kind::merged, 0, static_cast<std::uint16_t>(layers.size() - 1 - index)};
        }
    }
    loose_children_ = 0;
    for (std::uint32_t i = 0; i < children_.size(); ++i) {
        Child& child = children_[i];
        loose_children_ |= std::uint64_t{child.has_loose} << i;
        if (!child.is_written || child.numbers != numbers[i]) {
            child.numbers = numbers[i];
            child.is_written = true;
            write(child, i);
        }
    }
}

void MergedSquare::merge(JoinedLayer const& joined, MergedLayer& out) const {
    out.tile = tile_below(square_, joined.levels, joined.part);
    out.side = side_ >> joined.levels;
    out.stride = side_;
    int const column = static_cast<int>(morton_x(joined.part)) * out.side;
    int const row = static_cast<int>(morton_y(joined.part)) * out.side;
    out.grid = grid_.data() + row * side_ + column;
    out.first = tile_below(square_, levels(), joined.number / max_layers);
    out.first_layer = joined.number % max_layers;
    out.view = joined.view;
    Layer& layer = out.layer.layer;
    layer.at = static_cast<float>(joined.plane(spacing_ * column, spacing_ * row));
    layer.dx = static_cast<float>(joined.plane.dx);
    layer.dy = static_cast<float>(joined.plane.dy);
    layer.error = static_cast<float>(joined.error + joined.difference);
    layer.body = joined.body;
    layer.velocity = joined.velocity;
    double const samples = 1 / spacing_; // a pixel: a power of two
    out.layer.first_column = static_cast<std::int8_t>(static_cast<int>(samples * joined.extent.left) - column);
    out.layer.first_row = static_cast<std::int8_t>(static_cast<int>(samples * joined.extent.top) - row);
    out.layer.last_column = static_cast<std::int8_t>(static_cast<int>(samples * joined.extent.right) - 1 - column);
    out.layer.last_row = static_cast<std::int8_t>(static_cast<int>(samples * joined.extent.bottom) - 1 - row);
    out.difference = static_cast<float>(joined.difference);
    out.newest_batch = joined.newest_batch;
    out.signature = joined.signature;
}

/// Where its samples lie.
PackedSample* MergedSquare::place_of(std::uint32_t index) {
    return grid_.data() + static_cast<std::uint32_t>(child_side_) *
                              (morton_y(index) * static_cast<std::uint32_t>(side_) + morton_x(index));
}

/// The child's samples to the grid, with the numbers of what they are joined to.
void MergedSquare::write(Child const& child, std::uint32_t index) {
    PackedSample* const to = place_of(index);
    switch (child_side_) {
    case 4:
        write_samples<4>(child, to);
        break;
    case 8:
        write_samples<8>(child, to);
        break;
    default:
        write_samples<16>(child, to);
    }
}

template <int side>
void MergedSquare::write_samples(Child const& child, PackedSample* to) const {
    if (child.framelet == nullptr) {
        for (int y = 0; y < side; ++y, to += side_) {
            std::fill_n(to, side, no_number << 24);
        }
        return;
    }
    using Row = std::uint32_t __attribute__((vector_size(4 * std::min(side, wide_count))));
    constexpr int step = sizeof(Row) / sizeof(PackedSample);
    std::uint32_t const first = std::uint32_t{child.numbers[0]} << 24;
    std::uint32_t const second = std::uint32_t{child.numbers[1]} << 24;
    std::uint32_t const third = std::uint32_t{child.numbers[2]} << 24;
    PackedSample const* from = samples_of(*child.framelet, side);
    for (int y = 0; y < side; ++y, from += side, to += side_) {
        for (int x = 0; x < side; x += step) {
            Row const samples = load_lanes<Row>(from + x);
            Row const layers = samples >> 24;
            Row const none = Row{} + (no_number << 24);
            Row const numbers =
                layers == 0 ? Row{} + first : (layers == 1 ? Row{} + second : (layers == 2 ? Row{} + third : none));
            store_lanes((samples & 0xffffffu) | numbers, to + x);
        }
    }
}

} // namespace framelet
