#include "server/sampling/plan/looks.h"

#include <algorithm>
#include <cmath>

#include "common/sample_worth.h"
#include "server/sampling/plan/moment_plan.h"

namespace framelet {
namespace {

/// A comparison over so many seconds counts as much as all that was known before.
constexpr float trusted_seconds = 0.2f;
/// Of outlines and of what is seen in a mirror before a camera that moves, and of what turns in the light: that is
/// expected to change although it has hardly been seen to, since detail hides it.
constexpr float restless_change = 0.005f;
/// What is seen sooner again says little of how fast it changes.
constexpr float least_seconds = 0.02f;
/// Beyond twice what is expected by chance it is a change.
constexpr float doubt = 2;

float samples_of(Piece const& piece) {
    return std::max(4 * piece.half_side.x * piece.half_side.y / (piece.spacing * piece.spacing), 1.0f);
}

/// Of a new piece with what shows of the same surface, summed over cells.
struct Comparison {
    int cells = 0;
    float squares = 0; ///< of the differences of luma
    float chance = 0; ///< their variance where nothing has changed
    float age = 0; ///< of what shows, seconds of scene time
    float change = 0; ///< as it was expected

    void add(Mirror const& mirror, Cell const& cell, Vec2 at, Piece const& piece, SceneTime scene_time);
};

/// `at`: the middle of the cell, pixels.
void Comparison::add(Mirror const& mirror, Cell const& cell, Vec2 at, Piece const& piece, SceneTime scene_time) {
    if (cell.share < cell_pixels || cell.is_outdated) { // a jump tells nothing of how fast looks change
        return;
    }
    Piece const& old = mirror.piece_of(cell);
    float const farther = std::min(cell.inverse_depth, piece.inverse_depth);
    float const nearer = std::max(cell.inverse_depth, piece.inverse_depth);
    if (old.body != piece.body || farther < nearer * (1 - surface_tolerance)) {
        return;
    }
    float const scale = mirror.scale_of(cell);
    float const difference = piece.luma + glm::dot(piece.slope, at - piece.centre) - mirror.luma_of(cell, at);
    float const side = 2 * std::max({piece.half_side.x, piece.half_side.y, scale * old.half_side.x});
    float const blur = piece.spacing / samples_of(piece) + scale * old.spacing / samples_of(old);
    ++cells;
    squares += difference * difference;
    chance += chance_difference(std::max(piece.detail, old.detail / scale), blur, side);
    age += static_cast<float>(std::abs(scene_time - mirror.time_of(cell)));
    change += old.change;
}

/// Over the cells whose middles lie in the piece.
Comparison compare(Mirror const& mirror, Piece const& piece, SceneTime scene_time) {
    auto const cell_from = [](float pixel) { return static_cast<int>(std::max(pixel, 0.0f)) / cell_side; };
    auto const middle = [](int cell) { return (static_cast<float>(cell) + 0.5f) * cell_side; };
    Vec2 const low = piece.centre - piece.half_side;
    Vec2 const high = piece.centre + piece.half_side;
    Comparison comparison;
    for (int row = cell_from(low.y); row < mirror.rows() && middle(row) <= high.y; ++row) {
        for (int column = cell_from(low.x); column < mirror.columns() && middle(column) <= high.x; ++column) {
            comparison.add(mirror, mirror.cell(column, row), {middle(column), middle(row)}, piece, scene_time);
        }
    }
    return comparison;
}

/// Mean squared luma a second.
float change_after(Comparison const& comparison) {
    if (comparison.cells == 0) {
        return 0;
    }
    float const share = 1 / static_cast<float>(comparison.cells);
    float const before = share * comparison.change;
    float const age = share * comparison.age;
    if (!(age > 0)) {
        return before;
    }
    float const beyond = std::max(share * (comparison.squares - doubt * comparison.chance), 0.0f);
    float const found = beyond / std::max(age, least_seconds);
    return before + age / (age + trusted_seconds) * (found - before);
}

} // namespace

FadingCode learn_fading(Mirror const& mirror, std::span<Piece> pieces, SceneTime scene_time, bool comparable,
                        bool has_outline, bool expects_change) {
    float change = 0, detail = 0;
    for (Piece& piece : pieces) {
        piece.change = comparable ? change_after(compare(mirror, piece, scene_time)) : 0;
        float expected = piece.change;
        bool const is_restless =
            (piece.body != static_body && !piece.rests) || (!mirror.camera_stands() && (piece.reflects || has_outline));
        if (is_restless && expects_change) {
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
