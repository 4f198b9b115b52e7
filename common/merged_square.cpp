#include "common/merged_square.h"

#include <algorithm>
#include <span>

namespace framelet {

namespace {

constexpr std::uint32_t no_number = 255; ///< of samples that are on no layer

/// What is joined has the number of its first layer.
constexpr std::uint8_t number_of(std::uint32_t child, std::uint32_t layer) {
    return static_cast<std::uint8_t>(child * max_layers + layer);
}
static_assert(MergedSquare::most_children * max_layers <= no_number);

Tile tile_below(Tile tile, int levels, std::uint32_t part) {
    return {(tile.code << 2 * levels) + part};
}

} // namespace

void MergedSquare::update(FrameletCache const& cache, Tile square, int depth, LayerJoining& joining) {
    square_ = square;
    depth_ = depth;
    std::uint64_t const newest = version(cache);
    if (newest != version_) {
        version_ = newest;
        if (load(cache)) {
            join(joining);
        }
    }
}

/// The newest one of its blocks.
std::uint64_t MergedSquare::version(FrameletCache const& cache) const {
    PixelRect const rect = cache.plane().tile_rect(square_);
    constexpr int block = FrameletCache::block_side;
    std::uint64_t newest = 0;
    for (int row = rect.top / block; row < (rect.bottom + block - 1) / block; ++row) {
        for (int column = rect.left / block; column < (rect.right + block - 1) / block; ++column) {
            newest = std::max(newest, cache.block_version(column, row));
        }
    }
    return newest;
}

/// True where something else is held than before.
bool MergedSquare::load(FrameletCache const& cache) {
    std::uint32_t const count = 1u << 2 * levels();
    bool changed = false;
    std::array<std::uint32_t, most_children> fresh;
    std::size_t count_of_fresh = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        Tile const tile = tile_below(square_, levels(), i);
        int const column = static_cast<int>(tile.column());
        int const row = static_cast<int>(tile.row());
        std::uint64_t const version = cache.version_of(depth_, column, row);
        if (version > 0 && children_.empty()) {
            int const pixels = cache.plane().tile_side(tile);
            child_side_ = std::min(framelet_side, pixels);
            side_ = child_side_ << levels();
            spacing_ = static_cast<double>(pixels) / child_side_;
            children_.resize(count);
            grid_.assign(static_cast<std::size_t>(side_ * side_), no_number << 24);
        }
        if (children_.empty() || version == children_[i].version) {
            continue;
        }
        changed = true;
        children_[i] = {};
        children_[i].version = version;
        children_[i].framelet = cache.find(depth_, column, row);
        if (children_[i].framelet != nullptr) {
            __builtin_prefetch(&children_[i].framelet->view);
            __builtin_prefetch(&children_[i].framelet->shape.layers);
            __builtin_prefetch(&children_[i].framelet->shape.loose);
            fresh[count_of_fresh++] = i;
        }
    }
    for (std::uint32_t const i : std::span(fresh).first(count_of_fresh)) {
        copy_layers(children_[i]);
    }
    return changed;
}

void MergedSquare::copy_layers(Child& child) {
    HeldShape const& shape = child.framelet->shape;
    child.layer_count = shape.layer_count;
    child.has_loose = !shape.loose.empty();
    child.view = child.framelet->view;
    child.batch = child.framelet->moment.batch;
    std::copy_n(shape.layers.begin(), shape.layer_count, child.layers.begin());
}

void MergedSquare::join(LayerJoining& joining) {
    joining.start(levels());
    for (std::uint32_t i = 0; i < children_.size(); ++i) {
        for (std::uint32_t layer = 0; layer < children_[i].layer_count; ++layer) {
            HeldLayer const& held = children_[i].layers[layer];
            if (held.last_column >= held.first_column) {
                joining.add(layer_of_child(i, layer));
            }
        }
    }
    joining.finish();
    keep(joining.layers());
}

JoinedLayer MergedSquare::layer_of_child(std::uint32_t index, std::uint32_t layer) const {
    Child const& child = children_[index];
    HeldLayer const& held = child.layers[layer];
    int const column = static_cast<int>(morton_x(index)) * child_side_;
    int const row = static_cast<int>(morton_y(index)) * child_side_;
    double const dx = held.layer.dx;
    double const dy = held.layer.dy;
    JoinedLayer out;
    out.plane = {held.layer.at - spacing_ * (dx * column + dy * row), dx, dy};
    out.box = {column + held.first_column, row + held.first_row, column + held.last_column, row + held.last_row};
    out.extent = {spacing_ * out.box.first_column, spacing_ * out.box.first_row, spacing_ * (out.box.last_column + 1),
                  spacing_ * (out.box.last_row + 1)};
    out.sums = sums_over(out.plane, out.extent);
    out.error = held.layer.error;
    out.view = child.view;
    out.body = held.layer.body;
    out.velocity = held.layer.velocity;
    out.newest_batch = child.batch;
    out.number = number_of(index, layer);
    out.signature = child.batch * 256 + out.number;
    out.levels = levels();
    out.part = index;
    return out;
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
        MergedLayer& merged = merged_.emplace_back(merge(joined));
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

MergedLayer MergedSquare::merge(JoinedLayer const& joined) const {
    MergedLayer out;
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
    out.layer.first_column = static_cast<std::int8_t>(joined.box.first_column - column);
    out.layer.first_row = static_cast<std::int8_t>(joined.box.first_row - row);
    out.layer.last_column = static_cast<std::int8_t>(joined.box.last_column - column);
    out.layer.last_row = static_cast<std::int8_t>(joined.box.last_row - row);
    out.difference = static_cast<float>(joined.difference);
    out.newest_batch = joined.newest_batch;
    out.signature = joined.signature;
    return out;
}

/// The child's samples to the grid, with the numbers of what they are joined to.
void MergedSquare::write(Child const& child, std::uint32_t index) {
    int const n = child_side_;
    PackedSample* to = grid_.data() + morton_y(index) * static_cast<std::uint32_t>(n * side_) +
                       morton_x(index) * static_cast<std::uint32_t>(n);
    if (child.framelet == nullptr) {
        for (int y = 0; y < n; ++y, to += side_) {
            std::fill_n(to, n, no_number << 24);
        }
        return;
    }
    constexpr PackedSample color = 0xffffff;
    std::array<PackedSample, max_layers> numbers;
    std::ranges::transform(child.numbers, numbers.begin(), [](std::uint32_t number) { return number << 24; });
    PackedSample const* from =
        n == framelet_side ? child.framelet->samples.data() : child.framelet->shape.reduced.data();
    for (int y = 0; y < n; ++y, from += n, to += side_) {
        for (int x = 0; x < n; ++x) {
            std::uint32_t const layer = layer_of(from[x]);
            std::uint32_t const number = layer == 0   ? numbers[0]
                                         : layer == 1 ? numbers[1]
                                         : layer == 2 ? numbers[2]
                                                      : no_number << 24;
            to[x] = (from[x] & color) | number;
        }
    }
}

} // namespace framelet
