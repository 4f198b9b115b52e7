// Renders places of scenes as estimators get to see them at many sample rates, each with its ideal density. In: scenes.
// Out: values that any number of estimators and templates can be judged by, without rendering again.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tests/evaluation/bench_scene.h"
#include "tests/evaluation/estimators/ideal_density.h"

namespace framelet::bench {

/// Number of levels at which a place is looked at. A place is a tile of a sample a pixel; the levels are those of the
/// quadtree from the coarsest one down: spacing 8, 4, 2, 1, 1/2 and 1/4 pixels. Of framelets coarser than the place its
/// part is taken.
inline constexpr int observed_levels = coarsest_levels + 1 + finest_levels;

/// Number of refresh intervals at which a place is looked at: 2^i oracle intervals, with four refreshes before the last
/// one.
inline constexpr int observed_intervals = 6;
inline constexpr int observed_refreshes = 5;
inline constexpr double oracle_rate = 120; ///< pictures a second
inline constexpr int oracle_times = 64;

constexpr double spacing_at(int level) {
    return static_cast<double>(1 << observed_levels) / static_cast<double>(8 << level);
}
constexpr double seconds_at(int interval) {
    return static_cast<double>(1 << interval) / oracle_rate;
}
/// Number of framelets of a level that lie in a place: 1, or 4 or 16 where they are smaller.
constexpr int framelets_at(int level) {
    return level <= coarsest_levels ? 1 : 1 << (2 * (level - coarsest_levels));
}

struct Place {
    Tile tile;
    SceneTime time = 0; ///< time of the last refresh, which is the middle of the oracle's window
    IdealDensity ideal;
    std::vector<float> luma; ///< luma of all framelets: read with `observed_samples`
};

/// Samples of the framelet `index` of a level, `ago` oracle intervals before the last refresh: display-encoded luma in
/// Morton order.
std::span<float const> observed_samples(Place const& place, int ago, int level, int index);

/// Number of values in a place's `luma`.
std::size_t observed_luma_size();

struct ObservationOptions {
    Viewport viewport{512, 512};
    int windows = 3; ///< number of times at which places are looked at
    int places = 4; ///< number of places at each of these times
    std::uint32_t seed = 1; ///< seed from which times and places are drawn
    OracleParameters oracle;
};

/// Renders random places at random times of a scene as the server does (sample centres, display bytes). The scene must
/// last 2 seconds; it is posed anew.
std::vector<Place> observe_places(BenchScene& scene, ObservationOptions const& options);

} // namespace framelet::bench
