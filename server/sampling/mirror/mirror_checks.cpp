#include "server/sampling/mirror/mirror_checks.h"

#include <algorithm>
#include <cmath>

#include <glm/vector_relational.hpp>

#include "common/error.h"

namespace framelet {
namespace {

/// What is nearer by less than this share of its inverse depth is not looked for: tree crowns are full of it.
constexpr float nearer_share = 0.25f;
/// Standard deviations beyond which the difference of a probe is a change, or the sum of all differences around it.
constexpr float doubt = 4;
/// Luma by which light has to be known better for a place to be stale: a display step.
constexpr float least_learnt = 1.0f / 255;

Cell const& cell_at(Mirror const& mirror, Vec2 at) {
    return mirror.cell(static_cast<int>(at.x) / cell_side, static_cast<int>(at.y) / cell_side);
}

/// Calls `look` with each position of a grid.
template <class Look>
void for_each_position(RayGrid const& grid, Viewport viewport, Look look) {
    int const columns = grid.columns(viewport);
    int const rows = grid.rows(viewport);
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            look(grid.position(column, row));
        }
    }
}

/// True where the cell of a position, or one beside it, shows something about as near.
bool shows_as_near(Mirror const& mirror, Vec2 at, float inverse_depth) {
    int const column = static_cast<int>(at.x) / cell_side;
    int const row = static_cast<int>(at.y) / cell_side;
    float const least = inverse_depth * (1 - nearer_share);
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, mirror.rows() - 1); ++y) {
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, mirror.columns() - 1); ++x) {
            if (mirror.cell(x, y).inverse_depth >= least) {
                return true;
            }
        }
    }
    return false;
}

/// Difference in luma, of one probe or summed over some.
struct Difference {
    float luma = 0;
    float chance = 0; ///< its variance where nothing has changed; 0: not known

    bool beyond_chance() const { return luma * luma > doubt * doubt * chance; }
};

/// Variance of the luma by which two looks at one surface differ by chance: the detail between the samples of both
/// (`blur`: the sum of their spacings); a share of the detail that grows with the side of the piece, for what is no
/// slope; display steps. `detail` as of a piece, lengths in pixels of the same picture.
float chance_difference(float detail, float blur, float side) {
    constexpr float bend_share = 0.3f, rounding = 4e-6f;
    return detail * (blur + bend_share * side) + rounding;
}

/// Compares what a probe really shows with what the viewer does.
Difference compare(Mirror const& mirror, Probe const& probe, float luma) {
    Cell const& shown = cell_at(mirror, probe.position);
    if (!shown.is_shown()) { // what showed has gone
        return {};
    }
    Piece const& piece = mirror.piece_of(shown);
    float const scale = mirror.scale_of(shown);
    float const side = 2 * scale * std::max(piece.half_side.x, piece.half_side.y);
    return {luma - probe.luma, chance_difference(piece.detail / scale, probe.spacing + scale * piece.spacing, side)};
}

/// By how much the luma of a place is another one since more is known of its light. Neither texture nor chance is in
/// it: the same light is looked up at the same place.
float learnt_luma(Probe const& probe, float luma, SampleLight const& now) {
    constexpr float encoding = 2.2f; // luma goes by this root of light
    bool const is_known = now.light > 0 && probe.light > 0;
    float const most = std::max(now.light, probe.light);
    return is_known ? luma * now.share * std::abs(now.light - probe.light) / (most * encoding) : 0;
}

} // namespace

std::vector<CellFault> find_wrong(Mirror const& mirror, RayGrid const& grid, std::span<float const> inverse_depth) {
    std::size_t const columns = static_cast<std::size_t>(grid.columns(mirror.viewport()));
    FRAMELET_CHECK(inverse_depth.size() == columns * static_cast<std::size_t>(grid.rows(mirror.viewport())));
    std::vector<CellFault> faults;
    auto seen = inverse_depth.begin();
    for_each_position(grid, mirror.viewport(), [&](Vec2 at) {
        if (!shows_as_near(mirror, at, *seen++)) {
            faults.push_back({.at = at, .side = grid.spacing, .is_wrong = true});
        }
    });
    return faults;
}

void list_probes(Mirror const& mirror, RayGrid const& grid, bool of_any_time, std::vector<Probe>& probes) {
    probes.clear();
    Vec2 const size(mirror.viewport().width, mirror.viewport().height);
    for_each_position(grid, mirror.viewport(), [&](Vec2 at) {
        Cell const& shown = cell_at(mirror, at);
        if (shown.is_shown() && mirror.covers(shown, at) && !mirror.piece_of(shown).is_outlier &&
            (of_any_time || mirror.time_of(shown) != mirror.view().scene_time)) {
            Vec2 const middle = mirror.position_of(shown);
            bool const compares_light = of_any_time && glm::all(glm::greaterThanEqual(middle, Vec2(0))) &&
                                        glm::all(glm::lessThan(middle, size));
            Vec2 const position = compares_light ? middle : at;
            float const light = compares_light ? mirror.piece_of(shown).light : 0;
            probes.push_back({position, 1, mirror.luma_of(shown, position), light});
        }
    });
}

std::vector<CellFault> find_stale(Mirror const& mirror, std::span<Probe const> probes, ProbeLooks const& looks,
                                  int spacing) {
    FRAMELET_CHECK(probes.size() == looks.luma.size());
    FRAMELET_CHECK(looks.light.empty() || looks.light.size() == probes.size());
    if (probes.empty()) {
        return {};
    }
    int const columns = mirror.viewport().width / spacing + 3; // one beyond each side
    auto const index_at = [&](Vec2 at) {
        return (static_cast<int>(at.y) / spacing + 1) * columns + static_cast<int>(at.x) / spacing + 1;
    };
    std::vector<Difference> differences(static_cast<std::size_t>(columns * (mirror.viewport().height / spacing + 3)));
    for (std::size_t i = 0; i < probes.size(); ++i) {
        differences[static_cast<std::size_t>(index_at(probes[i].position))] = compare(mirror, probes[i], looks.luma[i]);
    }
    std::vector<CellFault> faults;
    for (std::size_t k = 0; k < probes.size(); ++k) {
        Probe const& probe = probes[k];
        int const at = index_at(probe.position);
        Difference const own = differences[static_cast<std::size_t>(at)];
        Difference around;
        for (int const row : {at - columns, at, at + columns}) {
            for (int i = row - 1; i <= row + 1; ++i) {
                around.luma += differences[static_cast<std::size_t>(i)].luma;
                around.chance += differences[static_cast<std::size_t>(i)].chance;
            }
        }
        if (own.chance > 0 && (own.beyond_chance() || around.beyond_chance())) {
            faults.push_back({.at = probe.position, .side = spacing, .stale = own.luma * own.luma});
        } else if (!looks.light.empty()) {
            float const learnt = learnt_luma(probe, looks.luma[k], looks.light[k]);
            if (learnt > least_learnt) {
                faults.push_back({.at = probe.position, .side = spacing, .stale = learnt * learnt});
            }
        }
    }
    return faults;
}

} // namespace framelet
