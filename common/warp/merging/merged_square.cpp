#include "common/warp/merging/merged_square.h"

#include <algorithm>
#include <bit>
#include <functional>

#include "common/mix_bits.h"
#include "common/morton.h"
#include "common/simd/lanes.h"

namespace framelet {

namespace {

constexpr std::uint32_t no_number = 255; ///< of samples that are on no layer

static_assert(MergedSquare::most_children * max_layers <= no_number);

/// The moving grid of a framelet, of so many samples along a side.
PackedSample const* samples_of(CachedFramelet const& framelet, int side) {
    return side == framelet_side ? framelet.samples.data() : framelet.shape.reduced.data();
}

Tile tile_below(Tile tile, int levels, std::size_t part) {
    return {(tile.code << 2 * levels) + static_cast<std::uint32_t>(part)};
}

/// Number of a layer among all layers of a square.
std::uint32_t number_of(std::size_t index, std::size_t layer) {
    return static_cast<std::uint32_t>(index * max_layers + layer);
}

} // namespace

void MergedSquare::update(FrameletCache const& cache, Tile square, int depth, CoplanarMerging& merging) {
    square_ = square;
    depth_ = depth;
    SquareVersions const& versions = cache.versions(depth, square.column(), square.row());
    std::uint64_t const changed = changes(versions);
    versions_ = versions;
    if (changed != 0) {
        load(cache, changed);
        merging.merge(*layers_, {child_side_, spacing_});
        keep(merging);
    }
}

Tile MergedSquare::child_tile(std::size_t index) const {
    return tile_below(square_, levels(), SquareLayers::part_at(index));
}

/// A bit for each child of which something else is held than before.
std::uint64_t MergedSquare::changes(SquareVersions const& versions) const {
    std::uint64_t out = 0;
    for (std::size_t i = 0; i < most_children; ++i) {
        out |= std::uint64_t{versions.tiles[i] != versions_.tiles[i]} << SquareLayers::index_of(i);
    }
    return out;
}

/// Loads the framelets that have changed. What is far away in memory is fetched before it is looked at.
void MergedSquare::load(FrameletCache const& cache, std::uint64_t changed) {
    if (children_.empty()) {
        make_room(cache.plane());
    }
    for (std::uint64_t left = changed; left != 0; left &= left - 1) {
        auto const index = static_cast<std::size_t>(std::countr_zero(left));
        Tile const tile = child_tile(index);
        CachedFramelet const* const framelet =
            cache.find(depth_, static_cast<int>(tile.column()), static_cast<int>(tile.row()));
        children_[index] = {};
        children_[index].framelet = framelet;
        if (framelet != nullptr) {
            __builtin_prefetch(framelet);
            __builtin_prefetch(&framelet->shape.layers);
            __builtin_prefetch(samples_of(*framelet, child_side_));
            for (int row = 0; row < child_side_; ++row) {
                __builtin_prefetch(grid_.data() + offset_of(index) + row * side_, 1);
            }
        }
    }
    if (!set_layers(changed)) {
        layers_->forget_motions();
        set_layers(~std::uint64_t{0});
    }
}

void MergedSquare::make_room(ImagePlane const& plane) {
    int const pixels = plane.tile_side(tile_below(square_, levels(), 0));
    child_side_ = std::min(framelet_side, pixels);
    side_ = child_side_ << levels();
    spacing_ = static_cast<double>(pixels) / child_side_;
    children_.resize(most_children);
    layers_ = std::make_unique<SquareLayers>();
    grid_.assign(static_cast<std::size_t>(side_ * side_), no_number << 24);
    written_ = ~std::uint64_t{0};
}

bool MergedSquare::set_layers(std::uint64_t children) {
    for (std::uint64_t left = children; left != 0; left &= left - 1) {
        auto const index = static_cast<std::size_t>(std::countr_zero(left));
        CachedFramelet const* const framelet = children_[index].framelet;
        with_outliers_ &= ~(std::uint64_t{1} << index);
        if (framelet == nullptr) {
            layers_->clear(index);
            continue;
        }
        with_outliers_ |= std::uint64_t{!framelet->shape.outliers.empty()} << index;
        if (!layers_->set(index, framelet->view, framelet->moment.batch, framelet->shape)) {
            return false;
        }
    }
    return true;
}

/// Keeps what was merged and writes framelets to the grid; those that are as they were, and merged as they were, are
/// there already.
void MergedSquare::keep(CoplanarMerging const& merging) {
    quads_.assign(merging.quads().begin(), merging.quads().end());
    merged_.clear();
    std::array<std::array<std::uint8_t, max_layers>, most_children> numbers{};
    for (CoplanarLayers const& coplanar : merging.coplanar()) {
        MergedLayer const& merged = merged_.emplace_back(merge(coplanar));
        for (std::size_t k = 0; k < max_layers; ++k) {
            for (std::uint64_t left = coplanar.parts[k]; left != 0; left &= left - 1) {
                numbers[static_cast<std::size_t>(std::countr_zero(left))][k] = static_cast<std::uint8_t>(merged.number);
            }
        }
    }
    for (std::size_t index = 0; index < most_children; ++index) {
        Child& child = children_[index];
        if (!child.is_written || child.numbers != numbers[index]) {
            child.numbers = numbers[index];
            child.is_written = true;
            if (SquareLayers::part_at(index) >> 2 * levels() == 0) {
                write(child, grid_.data() + offset_of(index));
                written_ |= std::uint64_t{1} << index;
            }
        }
    }
    find_ends();
}

/// Finds the ends of what is merged from its parts'; where of two layers each ends before the other somewhere, neither
/// counts.
void MergedSquare::find_ends() {
    auto const has_ends = [](Child const& child) {
        return child.framelet != nullptr &&
               std::ranges::any_of(child.framelet->shape.layers, [](HeldLayer const& l) { return l.ends_before != 0; });
    };
    if (std::ranges::none_of(children_, has_ends)) {
        return;
    }
    std::array<LayerSet, std::size_t{1} << 8> ends{};
    for (Child const& child : children_) {
        if (!has_ends(child)) {
            continue;
        }
        for (std::size_t k = 0; k < max_layers; ++k) {
            for (unsigned left = child.framelet->shape.layers[k].ends_before; left != 0; left &= left - 1) {
                std::uint32_t const other = child.numbers[static_cast<std::size_t>(std::countr_zero(left))];
                ends[child.numbers[k]][other / 32] |= 1u << other % 32;
            }
        }
    }
    for (MergedLayer& merged : merged_) {
        for (MergedLayer const& other : merged_) {
            if ((ends[merged.number][other.number / 32] >> other.number % 32 & 1) != 0 &&
                (ends[other.number][merged.number / 32] >> merged.number % 32 & 1) == 0) {
                merged.ends_before[other.number / 32] |= 1u << other.number % 32;
            }
        }
    }
}

/// The smallest tile (a framelet's, a quad's or the square) that has all of these parts.
Tile MergedSquare::tile_around(std::array<std::uint64_t, max_layers> const& parts) const {
    std::uint64_t const framelets = parts[0] | parts[1] | parts[2];
    if (std::has_single_bit(framelets)) {
        return child_tile(static_cast<std::size_t>(std::countr_zero(framelets)));
    }
    std::uint64_t const quads = (framelets | framelets >> 16 | framelets >> 32 | framelets >> 48) & 0xffffu;
    if (std::has_single_bit(quads)) {
        return tile_below(square_, levels() - 1, static_cast<std::size_t>(std::countr_zero(quads)));
    }
    return square_;
}

MergedLayer MergedSquare::merge(CoplanarLayers const& coplanar) const {
    MergedLayer out;
    Layer& layer = out.layer.layer;
    bool is_first = true;
    for (std::size_t k = 0; k < max_layers; ++k) {
        SquareLayers::Rows const& rows = layers_->rows(k);
        for (std::uint64_t left = coplanar.parts[k]; left != 0; left &= left - 1) {
            auto const index = static_cast<std::size_t>(std::countr_zero(left));
            std::uint32_t const number = number_of(index, k);
            if (is_first) {
                is_first = false;
                out.first = child_tile(index);
                out.first_layer = static_cast<std::uint32_t>(k);
                out.number = number;
                SquareLayers::Motion const& motion = layers_->motion(rows.motion[index]);
                out.view = motion.view;
                layer.body = motion.body;
                layer.drift = motion.drift;
                layer.error = rows.error[index]; // also where it is not a number
            }
            layer.error = std::max(layer.error, rows.error[index]);
            out.newest_batch = std::max(out.newest_batch, layers_->batch(index));
            out.decorrelation = std::max(out.decorrelation, children_[index].framelet->shape.decorrelation);
            out.signature = mix_in(out.signature, layers_->batch(index) * 256 + number);
        }
    }
    layer.error += static_cast<float>(coplanar.difference);
    out.difference = static_cast<float>(coplanar.difference);
    out.parts = coplanar.parts;
    set_tile(coplanar, tile_around(coplanar.parts), out);
    return out;
}

std::uint64_t MergedSquare::occupied_parts(std::array<std::uint64_t, max_layers> const& parts, Tile tile) const {
    int const below = depth_ - tile.depth();
    static_assert(most_levels == 3); // 8x8 framelets at most
    std::uint32_t const cells = 8u >> below; // of a framelet, along a side
    std::uint64_t out = 0;
    for (std::uint64_t left = parts[0] | parts[1] | parts[2]; left != 0; left &= left - 1) {
        Tile const child = child_tile(static_cast<std::size_t>(std::countr_zero(left)));
        std::uint32_t const column = (child.column() - (tile.column() << below)) * cells;
        std::uint32_t const row = (child.row() - (tile.row() << below)) * cells;
        std::uint64_t const line = ((std::uint64_t{1} << cells) - 1) << column;
        for (std::uint32_t i = row; i < row + cells; ++i) {
            out |= line << 8 * i;
        }
    }
    return out;
}

/// Sets what of a layer depends on the tile that it is looked at in. (Samples beyond the tile are not its own, though
/// they may have its number.)
void MergedSquare::set_tile(CoplanarLayers const& coplanar, Tile tile, MergedLayer& out) const {
    int const down = tile.depth() - square_.depth();
    out.tile = tile;
    out.occupied = occupied_parts(coplanar.parts, tile);
    out.side = side_ >> down;
    out.stride = side_;
    int const column = static_cast<int>(tile.column() - (square_.column() << down)) * out.side;
    int const row = static_cast<int>(tile.row() - (square_.row() << down)) * out.side;
    out.grid = grid_.data() + row * side_ + column;
    HeldLayer& held = out.layer;
    held.layer.at = static_cast<float>(coplanar.plane(spacing_ * column, spacing_ * row));
    held.layer.dx = static_cast<float>(coplanar.plane.dx);
    held.layer.dy = static_cast<float>(coplanar.plane.dy);
    double const samples = 1 / spacing_; // for each pixel: a power of two
    held.first_column = static_cast<std::int8_t>(static_cast<int>(samples * coplanar.extent.left) - column);
    held.first_row = static_cast<std::int8_t>(static_cast<int>(samples * coplanar.extent.top) - row);
    held.last_column = static_cast<std::int8_t>(static_cast<int>(samples * coplanar.extent.right) - 1 - column);
    held.last_row = static_cast<std::int8_t>(static_cast<int>(samples * coplanar.extent.bottom) - 1 - row);
}

std::optional<MergedSquare::GridPosition> MergedSquare::position_in_grid(PackedSample const* sample) const {
    std::less<> const is_before;
    if (grid_.empty() || is_before(sample, grid_.data()) || !is_before(sample, grid_.data() + grid_.size())) {
        return std::nullopt;
    }
    auto const offset = static_cast<int>(sample - grid_.data());
    return GridPosition{offset % side_, offset / side_};
}

MergedSquare::GridPosition MergedSquare::position_of_child(std::size_t index) const {
    auto const offset = static_cast<int>(offset_of(index));
    return {offset % side_, offset / side_};
}

/// Index in the grid of a child's first sample.
std::size_t MergedSquare::offset_of(std::size_t index) const {
    auto const part = static_cast<std::uint32_t>(SquareLayers::part_at(index));
    return static_cast<std::uint32_t>(child_side_) *
           (morton_y(part) * static_cast<std::uint32_t>(side_) + morton_x(part));
}

/// Writes a child's samples to the grid, with the numbers of what they are merged with.
void MergedSquare::write(Child const& child, PackedSample* to) const {
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
