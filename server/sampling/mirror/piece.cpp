#include "server/sampling/mirror/piece.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "common/color.h"
#include "common/morton.h"

namespace framelet {
namespace {

/// Greatest inverse depth that is told apart, 1 / metres.
constexpr float most_inverse_depth = 1e6f;
/// The least detail, a quarter of a display step, squared: less than that is none.
constexpr float least_detail = 1e-6f;
/// Weight of the whole framelet's detail in that of a piece, which has few samples to tell it by.
constexpr float common_share = 0.25f;
/// Inverse depths of one surface differ by less than this share of the greater one.
constexpr float surface_tolerance = 0.05f;

constexpr float bounded(float inverse_depth) {
    return inverse_depth >= 0 ? std::min(inverse_depth, most_inverse_depth) : 0; // NaN becomes 0
}

/// Side of the parts that a tile of this side is cut into, pixels.
constexpr int part_side(int tile_side) {
    return std::min(std::clamp(tile_side / 8, 8, 16), tile_side);
}

/// Sums over samples of one layer.
struct Sum {
    float count = 0, luma = 0, light = 0, x = 0, y = 0, xx = 0, yy = 0, luma_x = 0, luma_y = 0;
    Vec2 low{INFINITY}, high{-INFINITY};
    bool reflects = false;

    void add(Framelet const& rendered, std::uint32_t i, float value) {
        auto const column = static_cast<float>(morton_x(i));
        auto const row = static_cast<float>(morton_y(i));
        count += 1;
        luma += value;
        x += column;
        y += row;
        xx += column * column;
        yy += row * row;
        luma_x += value * column;
        luma_y += value * row;
        low = glm::min(low, Vec2(column, row));
        high = glm::max(high, Vec2(column, row));
        reflects = reflects || rendered.reflects[i];
        light += rendered.light.empty() ? 0.0f : rendered.light[i];
    }
};

/// The same sums over samples that lie on no layer.
struct OutlierSum : Sum {
    float inverse_depth = 0, least = INFINITY, most = 0;
    Drift drift; ///< its jerk is the greatest
    BodyNumber body = static_body; ///< of the last one

    void add(Framelet const& rendered, std::uint32_t i, float value, Outlier const& sample) {
        float const w = bounded(sample.inverse_depth);
        Sum::add(rendered, i, value);
        inverse_depth += w;
        least = std::min(least, w);
        most = std::max(most, w);
        drift.velocity += sample.drift.velocity;
        drift.acceleration += sample.drift.acceleration;
        drift.jerk = std::max(drift.jerk, sample.drift.jerk);
        drift.swing = sample.drift.swing;
        body = sample.body;
    }
};

/// Makes a piece of the sums over its samples; `put_on` sets its depth and what carries it.
Piece piece_of(Sum const& sum, Vec2 corner, float spacing, float detail) {
    Piece piece;
    float const share = 1 / sum.count;
    Vec2 const middle = share * Vec2(sum.x, sum.y);
    Vec2 const side = sum.high - sum.low + 1.0f; // in samples
    // A piece that does not fill its box covers as much as it has samples.
    float const filled = std::sqrt(sum.count / (side.x * side.y));
    bool const whole = filled > 0.999f;
    Vec2 const centre = whole ? 0.5f * (sum.low + sum.high) : middle;
    piece.centre = corner + (centre + 0.5f) * spacing;
    piece.half_side = (0.5f * spacing * filled) * side;
    piece.spacing = spacing;
    piece.luma = share * sum.luma;
    piece.light = share * sum.light;
    auto const slope = [&](float product, float square, float at) {
        float const spread = share * square - at * at;
        return spread > 0.1f ? (share * product - at * piece.luma) / (spread * spacing) : 0.0f;
    };
    piece.slope = {slope(sum.luma_x, sum.xx, middle.x), slope(sum.luma_y, sum.yy, middle.y)};
    piece.detail = std::max(detail / spacing, least_detail);
    piece.reflects = sum.reflects;
    return piece;
}

void put_on(Layer const& layer, Vec2 corner, Piece& piece) {
    Vec2 const from = piece.centre - corner;
    piece.inverse_depth = bounded(layer.at + from.x * layer.dx + from.y * layer.dy);
    piece.depth_slope = {layer.dx, layer.dy};
    piece.error = layer.error;
    piece.drift = layer.drift.at(from);
    piece.body = layer.body;
}

void put_on(OutlierSum const& sum, Piece& piece) {
    piece.inverse_depth = sum.inverse_depth / sum.count;
    piece.drift = {sum.drift.velocity / sum.count, sum.drift.acceleration / sum.count, sum.drift.jerk, sum.drift.swing};
    piece.body = sum.body;
    piece.is_outlier = true;
}

/// Detail of each block of 2x2 samples: half the mean squared difference of neighbours, those in the next blocks to the
/// right and below among them, or what changes just between two blocks were no detail. Where an edge divides a block it
/// is as large as the variance of that.
std::array<float, framelet_samples / 4> details_of(std::span<float const, framelet_samples> luma) {
    std::array<float, framelet_samples / 4> details;
    for (std::uint32_t block = 0; block < details.size(); ++block) {
        float sum = 0, pairs = 0;
        for (std::uint32_t i = 4 * block; i < 4 * block + 4; ++i) {
            std::uint32_t const column = morton_x(i), row = morton_y(i);
            auto const add = [&](std::uint32_t neighbour) {
                float const difference = luma[neighbour] - luma[i];
                sum += difference * difference;
                pairs += 1;
            };
            if (column + 1 < framelet_side) {
                add(morton_index(column + 1, row));
            }
            if (row + 1 < framelet_side) {
                add(morton_index(column, row + 1));
            }
        }
        details[block] = 0.5f * sum / pairs;
    }
    return details;
}

} // namespace

PixelRect part_of(Piece const& piece, ImagePlane const& plane) {
    PixelRect const rect = plane.tile_rect(piece.of.tile);
    int const side = part_side(rect.width());
    int const left = rect.left + (static_cast<int>(piece.centre.x) - rect.left) / side * side;
    int const top = rect.top + (static_cast<int>(piece.centre.y) - rect.top) / side * side;
    return {left, top, left + side, top + side};
}

void cut_pieces(Framelet const& rendered, DisplayFramelet const& shown, FrameletShape const& shape,
                ImagePlane const& plane, SceneTime scene_time, std::uint64_t batch, std::vector<Piece>& pieces) {
    std::array<float, framelet_samples> luma;
    for (std::size_t i = 0; i < luma.size(); ++i) {
        luma[i] = display_luma(shown.red[i], shown.green[i], shown.blue[i]);
    }
    auto const details = details_of(luma);
    float const common = std::reduce(details.begin(), details.end()) / static_cast<float>(details.size());
    PixelRect const rect = plane.tile_rect(shown.tile);
    Vec2 const corner(rect.left, rect.top);
    float const spacing = plane.sample_spacing(shown.tile);
    auto const parts = static_cast<std::uint32_t>(rect.width() / part_side(rect.width()));
    std::uint32_t const count = framelet_samples / (parts * parts);
    bool const moves = shape.moves();
    auto outliers = shape.outliers.begin();
    for (std::uint32_t first = 0; first < framelet_samples; first += count) {
        float const local = std::reduce(details.begin() + first / 4, details.begin() + (first + count) / 4) /
                            (0.25f * static_cast<float>(count));
        float const detail = (1 - common_share) * local + common_share * common;
        std::array<Sum, max_layers> sums;
        OutlierSum all;
        auto const first_outlier = outliers;
        for (std::uint32_t i = first; i < first + count; ++i) {
            if (shape.layer_of[i] == FrameletShape::outlier) {
                all.add(rendered, i, luma[i], *outliers++);
            } else {
                sums[shape.layer_of[i]].add(rendered, i, luma[i]);
            }
        }
        auto const append = [&](Sum const& sum, auto const& put) {
            if (sum.count > 0) {
                pieces.push_back(piece_of(sum, corner, spacing, detail));
                pieces.back().scene_time = scene_time;
                pieces.back().of = {batch, shown.tile};
                pieces.back().moves = moves;
                pieces.back().is_brief = shape.is_brief;
                pieces.back().is_supersampled = rendered.is_supersampled;
                put(pieces.back());
            }
        };
        for (std::size_t k = 0; k < shape.layer_count; ++k) {
            append(sums[k], [&](Piece& piece) { put_on(shape.layers[k], corner, piece); });
        }
        std::array<OutlierSum, 2> halves;
        if (all.most - all.least > surface_tolerance * all.most) {
            auto sample = first_outlier;
            for (std::uint32_t i = first; i < first + count; ++i) {
                if (shape.layer_of[i] == FrameletShape::outlier) {
                    bool const near = bounded(sample->inverse_depth) > 0.5f * (all.least + all.most);
                    halves[near ? 0 : 1].add(rendered, i, luma[i], *sample++);
                }
            }
        } else {
            halves[0] = all;
        }
        for (OutlierSum const& half : halves) {
            append(half, [&](Piece& piece) { put_on(half, piece); });
        }
    }
}

} // namespace framelet
