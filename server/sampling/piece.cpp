#include "server/sampling/piece.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "common/color.h"
#include "common/morton.h"

namespace framelet {
namespace {

/// Nearer than this nothing is told apart, 1 / metres.
constexpr float most_inverse_depth = 1e6f;
/// A quarter of a display step, squared: less detail than that is none.
constexpr float least_detail = 1e-6f;
/// A piece has few samples to tell its detail by: so much of the whole framelet's is taken into it.
constexpr float common_share = 0.25f;

constexpr float inverse_of(float depth) {
    float const inverse = 1 / depth;
    return inverse >= 0 ? std::min(inverse, most_inverse_depth) : 0; // of what is not a number: none
}

/// Of parts that a tile of this side is cut into, pixels.
constexpr int part_side(int tile_side) {
    return std::clamp(tile_side / 8, 8, 16) < tile_side ? std::clamp(tile_side / 8, 8, 16) : tile_side;
}

/// What is summed over samples on one surface.
struct Sum {
    float count = 0, w = 0, luma = 0, x = 0, y = 0, xx = 0, yy = 0, luma_x = 0, luma_y = 0;
    Vec2 low{INFINITY}, high{-INFINITY};
    Vec3 velocity{0};
    bool reflects = false;
    BodyNumber body = static_body;
};

/// The body that carries the most of some samples, if any carries most (Boyer and Moore).
BodyNumber majority(std::span<BodyNumber const> bodies) {
    BodyNumber body = bodies.front();
    int lead = 0;
    for (BodyNumber const other : bodies) {
        body = lead == 0 ? other : body;
        lead += other == body ? 1 : -1;
    }
    return body;
}

Piece piece_of(Sum const& sum, Vec2 corner, float spacing, float detail) {
    Piece piece;
    float const share = 1 / sum.count;
    Vec2 const middle = share * Vec2(sum.x, sum.y);
    Vec2 const side = sum.high - sum.low + 1.0f; // in samples
    // What does not fill its box covers as much as it has samples.
    float const filled = std::sqrt(sum.count / (side.x * side.y));
    bool const whole = filled > 0.999f;
    Vec2 const centre = whole ? 0.5f * (sum.low + sum.high) : middle;
    piece.centre = corner + (centre + 0.5f) * spacing;
    piece.half_side = (0.5f * spacing * filled) * side;
    piece.inverse_depth = share * sum.w;
    piece.spacing = spacing;
    piece.luma = share * sum.luma;
    auto const slope = [&](float product, float square, float at) {
        float const spread = share * square - at * at;
        return spread > 0.1f ? (share * product - at * piece.luma) / (spread * spacing) : 0.0f;
    };
    piece.slope = {slope(sum.luma_x, sum.xx, middle.x), slope(sum.luma_y, sum.yy, middle.y)};
    piece.detail = std::max(detail / spacing, least_detail);
    piece.velocity = share * sum.velocity;
    piece.body = sum.body;
    piece.reflects = sum.reflects;
    return piece;
}

} // namespace

void cut_pieces(Framelet const& rendered, DisplayFramelet const& shown, ImagePlane const& plane, SceneTime scene_time,
                std::vector<Piece>& pieces) {
    std::array<float, framelet_samples> luma;
    std::array<float, framelet_samples> inverse;
    std::array<float, framelet_samples / 4> details; // of each block of 2x2 samples
    float common = 0;
    for (std::size_t i = 0; i < luma.size(); ++i) {
        luma[i] = display_luma(shown.red[i], shown.green[i], shown.blue[i]);
        inverse[i] = inverse_of(rendered.depth[i]);
    }
    for (std::size_t block = 0; block < details.size(); ++block) {
        auto const four = std::span(luma).subspan(4 * block, 4);
        float const mean = 0.25f * (four[0] + four[1] + four[2] + four[3]);
        float sum = 0;
        for (float const value : four) {
            sum += (value - mean) * (value - mean);
        }
        details[block] = 0.25f * sum;
        common += details[block];
    }
    common /= static_cast<float>(details.size());
    PixelRect const rect = plane.tile_rect(rendered.tile);
    Vec2 const corner(rect.left, rect.top);
    float const spacing = plane.sample_spacing(rendered.tile);
    auto const parts = static_cast<std::size_t>(rect.width() / part_side(rect.width()));
    std::size_t const count = framelet_samples / (parts * parts);
    for (std::size_t first = 0; first < framelet_samples; first += count) {
        auto const depths = std::span(inverse).subspan(first, count);
        auto const [least, most] = std::ranges::minmax(depths);
        bool const deep = most - least > surface_tolerance * most;
        float const between = 0.5f * (least + most);
        BodyNumber const body =
            rendered.body.empty() ? static_body : majority(std::span(rendered.body).subspan(first, count));
        float local = 0;
        for (std::size_t block = first / 4; block < (first + count) / 4; ++block) {
            local += details[block];
        }
        float const detail = (1 - common_share) * local / static_cast<float>(count / 4) + common_share * common;
        std::array<Sum, 2> sums;
        for (std::size_t i = first; i < first + count; ++i) {
            BodyNumber const carrier = rendered.body.empty() ? static_body : rendered.body[i];
            Sum& sum = sums[(deep ? inverse[i] > between : carrier == body) ? 0 : 1];
            auto const x = static_cast<float>(morton_x(static_cast<std::uint32_t>(i)));
            auto const y = static_cast<float>(morton_y(static_cast<std::uint32_t>(i)));
            sum.count += 1;
            sum.w += inverse[i];
            sum.luma += luma[i];
            sum.x += x;
            sum.y += y;
            sum.xx += x * x;
            sum.yy += y * y;
            sum.luma_x += luma[i] * x;
            sum.luma_y += luma[i] * y;
            sum.low = glm::min(sum.low, Vec2(x, y));
            sum.high = glm::max(sum.high, Vec2(x, y));
            sum.velocity += rendered.velocity.empty() ? Vec3(0) : rendered.velocity[i];
            sum.reflects = sum.reflects || rendered.reflects[i];
            sum.body = carrier;
        }
        for (Sum const& sum : sums) {
            if (sum.count > 0) {
                pieces.push_back(piece_of(sum, corner, spacing, detail));
                pieces.back().scene_time = scene_time;
            }
        }
    }
}

} // namespace framelet
