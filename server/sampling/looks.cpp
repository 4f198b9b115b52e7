#include "server/sampling/looks.h"

#include <algorithm>
#include <cmath>

#include "common/sample_worth.h"
#include "server/sampling/moment_plan.h"

namespace framelet {
namespace {

constexpr int region_side = 32; ///< pixels
/// What was seen in a region is half forgotten after so long, seconds of scene time.
constexpr float region_memory = 0.5f;
/// A comparison over so many seconds counts as much as all that was known before.
constexpr float trusted_seconds = 0.2f;
/// Of what changes around a surface, and anywhere, that it is expected to change itself: what moves over its
/// neighbours may come over it.
constexpr float share_of_around = 0.25f, share_of_usual = 0.05f;
/// The least that is expected of anything, mean squared luma a second.
constexpr float least_change = 1e-5f;
/// What is seen in a mirror by a camera that moves.
constexpr float restless_change = 0.02f;
/// Beyond twice what is expected by chance it is a change.
constexpr float doubt = 2;

float samples_of(Piece const& piece) {
    return std::max(4 * piece.half_side.x * piece.half_side.y / (piece.spacing * piece.spacing), 1.0f);
}

} // namespace

Looks::Looks(Viewport viewport)
    : columns_((viewport.width + region_side - 1) / region_side),
      rows_((viewport.height + region_side - 1) / region_side),
      regions_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

/// The most of what is known of the region and those beside it.
float Looks::around(Vec2 at, SceneTime scene_time) const {
    int const column = static_cast<int>(at.x) / region_side;
    int const row = static_cast<int>(at.y) / region_side;
    float most = 0;
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows_ - 1); ++y) {
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns_ - 1); ++x) {
            Region const& region = regions_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                                            static_cast<std::size_t>(x)];
            auto const age = static_cast<float>(std::abs(scene_time - region.when));
            most = std::max(most, region.change * std::exp2(-age / region_memory));
        }
    }
    return most;
}

void Looks::note(Vec2 at, float change, SceneTime scene_time) {
    int const column = std::clamp(static_cast<int>(at.x) / region_side, 0, columns_ - 1);
    int const row = std::clamp(static_cast<int>(at.y) / region_side, 0, rows_ - 1);
    Region& region =
        regions_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)];
    auto const age = static_cast<float>(std::abs(scene_time - region.when));
    constexpr float share = 0.1f;
    float const before = region.change * std::exp2(-age / region_memory);
    region = {before + share * (change - before), scene_time};
    usual_ += 0.002f * (change - usual_);
}

FadingCode Looks::learn(Mirror const& mirror, std::span<Piece> pieces, SceneTime scene_time, bool comparable) {
    float change = 0, detail = 0;
    for (Piece& piece : pieces) {
        float before = 0, squares = 0, chance = 0, age = 0, scale = 1;
        int compared = 0;
        int const left = static_cast<int>(std::max(piece.centre.x - piece.half_side.x, 0.0f)) / cell_side;
        int const top = static_cast<int>(std::max(piece.centre.y - piece.half_side.y, 0.0f)) / cell_side;
        for (int row = top; comparable && row < mirror.rows(); ++row) {
            float const y = (static_cast<float>(row) + 0.5f) * cell_side;
            if (y > piece.centre.y + piece.half_side.y) {
                break;
            }
            for (int column = left; column < mirror.columns(); ++column) {
                Vec2 const at((static_cast<float>(column) + 0.5f) * cell_side, y);
                if (at.x > piece.centre.x + piece.half_side.x) {
                    break;
                }
                Cell const& cell = mirror.cell(column, row);
                if (cell.share < cell_side * cell_side) {
                    continue;
                }
                Piece const& old = mirror.piece_of(cell);
                float const farther = std::min(cell.inverse_depth, piece.inverse_depth);
                float const nearer = std::max(cell.inverse_depth, piece.inverse_depth);
                if (old.body != piece.body || farther < nearer * (1 - surface_tolerance)) {
                    continue;
                }
                scale = mirror.scale_of(cell);
                float const shown = mirror.luma_of(cell, at);
                float const seen = piece.luma + glm::dot(piece.slope, at - piece.centre);
                squares += (seen - shown) * (seen - shown);
                float const side = 2 * std::max({piece.half_side.x, piece.half_side.y, scale * old.half_side.x});
                float const blur = piece.spacing / samples_of(piece) + scale * old.spacing / samples_of(old);
                chance += chance_difference(std::max(piece.detail, old.detail / scale), blur, side);
                age += static_cast<float>(std::abs(scene_time - mirror.time_of(cell)));
                before += old.change;
                ++compared;
            }
        }
        if (compared > 0) {
            float const share = 1 / static_cast<float>(compared);
            age *= share;
            piece.change = share * before;
            if (age > 0) {
                float const beyond = std::max(share * (squares - doubt * chance), 0.0f);
                float const found = beyond / std::max(age, 0.02f);
                piece.change += age / (age + trusted_seconds) * (found - piece.change);
                note(piece.centre, found, scene_time);
            }
        }
        float expected = std::max(
            {piece.change, share_of_around * around(piece.centre, scene_time), share_of_usual * usual_, least_change});
        if (piece.reflects && !mirror.camera_stands()) {
            expected = std::max(expected, restless_change);
        }
        float const area = 4 * piece.half_side.x * piece.half_side.y;
        change += area * expected;
        detail += area * piece.detail;
    }
    // Per pixel of spacing, error grows by about so much of the detail.
    FadingCode const code = fading_code(detail > 0 ? change / (detail * error_growth) : 0);
    for (Piece& piece : pieces) {
        piece.fading = fading_rate(code);
    }
    return code;
}

} // namespace framelet
