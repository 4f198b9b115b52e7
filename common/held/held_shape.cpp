#include "common/held/held_shape.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/color.h"
#include "common/error.h"
#include "common/held/box_sums.h"

namespace framelet {

namespace {

constexpr std::size_t side = framelet_side;

/// Number of outliers for which room is kept for the next framelet of a tile.
constexpr std::size_t most_spare_outliers = 16;

/// Inverse depths that differ by more than this share are of different surfaces.
constexpr float clearly = 0.02f;

using Samples = std::array<PackedSample, framelet_samples>;

/// The index in rows of each sample in Morton order.
constexpr auto row_indices = [] {
    std::array<std::uint8_t, framelet_samples> out{};
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        out[i] = static_cast<std::uint8_t>(framelet_side * morton_y(i) + morton_x(i));
    }
    return out;
}();

constexpr PackedSample pack(std::uint32_t red, std::uint32_t green, std::uint32_t blue, std::uint32_t layer) {
    return red | green << 8 | blue << 16 | layer << 24;
}

void pack_rows(DisplayFramelet const& framelet, FrameletShape const* shape, Samples& rows) {
    Samples morton;
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        morton[i] = pack(framelet.red[i], framelet.green[i], framelet.blue[i], 0);
    }
    if (shape != nullptr) {
        for (std::size_t i = 0; i < framelet_samples; ++i) {
            morton[i] |= static_cast<std::uint32_t>(shape->layer_of[i]) << 24;
        }
    }
    // Samples 2i and 2i + 1 are neighbours.
    for (std::size_t i = 0; i < framelet_samples; i += 2) {
        std::memcpy(&rows[row_indices[i]], &morton[i], 2 * sizeof(PackedSample));
    }
}

void hold_outliers(FrameletShape const& shape, std::vector<HeldOutlier>& outliers) {
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        FRAMELET_CHECK(shape.layer_of[i] < shape.layer_count || shape.layer_of[i] == FrameletShape::outlier);
        if (shape.layer_of[i] == FrameletShape::outlier) {
            FRAMELET_CHECK(outliers.size() < shape.outliers.size());
            outliers.push_back({shape.outliers[outliers.size()], row_indices[i]});
        }
    }
    FRAMELET_CHECK(outliers.size() == shape.outliers.size());
    std::sort(outliers.begin(), outliers.end(),
              [](HeldOutlier const& a, HeldOutlier const& b) { return a.index < b.index; });
}

using ReducedSamples = std::array<PackedSample, framelet_samples / 4>;
using ReducedSums = std::array<float, framelet_samples / 4>;
using Weights = std::array<float, framelet_samples>;

/// Layer of each pixel: the one that most of its n x n samples lie on. `weights` is 1 for those samples, else 0.
void choose_layers(Samples const& samples, std::size_t n, ReducedSamples& layers, Weights& weights) {
    for (std::size_t y = 0; y < side; y += n) {
        for (std::size_t x = 0; x < side; x += n) {
            std::array<std::uint8_t, max_layers + 1> counts{};
            for (std::size_t j = 0; j < n; ++j) {
                for (std::size_t i = 0; i < n; ++i) {
                    ++counts[layer_of(samples[(y + j) * side + x + i])];
                }
            }
            auto const most =
                static_cast<std::uint32_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
            layers[(y * side / n + x) / n] = most << 24;
            for (std::size_t j = 0; j < n; ++j) {
                for (std::size_t i = 0; i < n; ++i) {
                    std::size_t const at = (y + j) * side + x + i;
                    weights[at] = layer_of(samples[at]) == most ? 1.0f : 0.0f;
                }
            }
        }
    }
}

/// Means in linear light of n x n samples. `reduced` has the layers of the pixels and no colour yet. No weights: all
/// are 1.
void reduce_colors(Samples const& samples, std::size_t n, Weights const* weights, ReducedSamples& reduced) {
    TransferTables const& tables = transfer_tables();
    std::size_t const pixels = side / n * (side / n);
    ReducedSums total;
    if (weights == nullptr) {
        total.fill(static_cast<float>(n * n));
    } else {
        box_sums(*weights, n, total);
    }
    for (int shift = 0; shift < 24; shift += 8) {
        Weights linear;
        for (std::size_t i = 0; i < framelet_samples; ++i) {
            linear[i] = tables.linear[samples[i] >> shift & 255u];
        }
        if (weights != nullptr) {
            for (std::size_t i = 0; i < framelet_samples; ++i) {
                linear[i] *= (*weights)[i];
            }
        }
        ReducedSums sums;
        box_sums(linear, n, sums);
        for (std::size_t i = 0; i < pixels; ++i) {
            reduced[i] |= static_cast<std::uint32_t>(srgb_byte_from_linear(sums[i] / total[i])) << shift;
        }
    }
}

/// Keeps one outlier, the nearest, for each pixel most of whose samples are outliers.
void reduce_outliers(std::size_t n, ReducedSamples const& reduced, std::vector<HeldOutlier>& outliers) {
    std::size_t const pixels = side / n;
    std::array<HeldOutlier const*, framelet_samples> nearest{};
    for (HeldOutlier const& one : outliers) {
        HeldOutlier const*& best = nearest[one.index / side / n * pixels + one.index % side / n];
        if (best == nullptr || one.sample.inverse_depth > best->sample.inverse_depth) {
            best = &one;
        }
    }
    std::array<HeldOutlier, framelet_samples / 4> kept;
    std::size_t count = 0;
    for (std::size_t i = 0; i < pixels * pixels; ++i) {
        if (layer_of(reduced[i]) == FrameletShape::outlier) {
            kept[count++] = {nearest[i]->sample, static_cast<std::uint8_t>(i)};
        }
    }
    outliers.assign(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count));
}

void hold_boxes(PackedSample const* grid, HeldShape& held) {
    for (int row = 0; row < held.side; ++row) {
        for (int column = 0; column < held.side; ++column) {
            std::size_t const layer = layer_of(*grid++);
            if (layer >= held.layer_count) {
                continue;
            }
            HeldLayer& own = held.layers[layer];
            if (own.last_column < own.first_column) {
                own.first_column = own.last_column = static_cast<std::int8_t>(column);
                own.first_row = static_cast<std::int8_t>(row);
            }
            own.first_column = std::min(own.first_column, static_cast<std::int8_t>(column));
            own.last_column = std::max(own.last_column, static_cast<std::int8_t>(column));
            own.last_row = static_cast<std::int8_t>(row);
        }
    }
}

} // namespace

bool is_in_place(HeldShape const& held, SceneTime from, SceneTime to, BodyMotions const& motions) {
    auto const is_there = [&](auto const& one) {
        return !one.drift.any() && (one.body == static_body || motions.between(one.body, from, to) == Motion{});
    };
    return std::all_of(held.layers.begin(), held.layers.begin() + held.layer_count,
                       [&](HeldLayer const& layer) { return is_there(layer.layer); }) &&
           std::ranges::all_of(held.outliers, [&](HeldOutlier const& outlier) { return is_there(outlier.sample); });
}

void hold(DisplayFramelet const& framelet, FrameletShape const* shape, int samples_per_pixel, Samples& samples,
          HeldShape& held) {
    FRAMELET_CHECK(shape == nullptr || shape->layer_count <= max_layers);
    pack_rows(framelet, shape, samples);
    held.layer_count = shape == nullptr ? 1 : shape->layer_count;
    held.side = static_cast<std::uint8_t>(framelet_side / samples_per_pixel);
    held.moves = shape != nullptr && shape->moves();
    held.is_brief = shape != nullptr && shape->is_brief;
    held.decorrelation = shape == nullptr ? DecorrelationCode{0} : shape->decorrelation;
    held.layers.fill({});
    held.outliers.clear();
    if (shape != nullptr) {
        for (std::size_t i = 0; i < shape->layer_count; ++i) {
            held.layers[i].layer = shape->layers[i];
        }
        hold_outliers(*shape, held.outliers);
    }
    held.reduced.fill(0);
    bool const mixed = held.layer_count != 1 || !held.outliers.empty();
    if (samples_per_pixel > 1) {
        auto const n = static_cast<std::size_t>(samples_per_pixel);
        Weights weights;
        if (mixed) {
            choose_layers(samples, n, held.reduced, weights);
        }
        reduce_colors(samples, n, mixed ? &weights : nullptr, held.reduced);
        reduce_outliers(n, held.reduced, held.outliers);
    }
    if (held.outliers.capacity() > std::max(most_spare_outliers, held.outliers.size())) {
        held.outliers.shrink_to_fit();
    }
    if (!mixed) {
        auto const last = static_cast<std::int8_t>(held.side - 1);
        held.layers[0].last_column = held.layers[0].last_row = last;
    } else {
        hold_boxes(samples_per_pixel > 1 ? held.reduced.data() : samples.data(), held);
    }
}

void find_ends(double spacing, Samples const& samples, HeldShape& held) {
    if (held.layer_count < 2) {
        return;
    }
    PackedSample const* const grid = held.side == framelet_side ? samples.data() : held.reduced.data();
    // times[a][b]: how often, of two neighbours on different layers, the nearer lies on a and the other one on b.
    std::array<std::array<int, max_layers>, max_layers> times{};
    auto const compare = [&](int x, int y, int dx, int dy) {
        std::uint32_t const one = layer_of(grid[y * held.side + x]);
        std::uint32_t const other = layer_of(grid[(y + dy) * held.side + x + dx]);
        if (one == other || one >= held.layer_count || other >= held.layer_count) {
            return;
        }
        auto const depth_of = [&](Layer const& layer) {
            return layer.at + layer.dx * static_cast<float>(spacing * (x + 0.5 * dx + 0.5)) +
                   layer.dy * static_cast<float>(spacing * (y + 0.5 * dy + 0.5));
        };
        Layer const& a = held.layers[one].layer;
        Layer const& b = held.layers[other].layer;
        float const nearer = depth_of(a) - depth_of(b);
        if (std::abs(nearer) > a.error + b.error + clearly * std::max(depth_of(a), depth_of(b))) {
            ++(nearer > 0 ? times[one][other] : times[other][one]);
        }
    };
    for (int y = 0; y < held.side; ++y) {
        for (int x = 0; x + 1 < held.side; ++x) {
            compare(x, y, 1, 0);
            compare(y, x, 0, 1);
        }
    }
    for (std::size_t i = 0; i < held.layer_count; ++i) {
        for (std::size_t k = 0; k < held.layer_count; ++k) {
            if (times[i][k] > times[k][i]) {
                held.layers[i].ends_before |= static_cast<std::uint8_t>(1u << k);
            }
        }
    }
}

} // namespace framelet
