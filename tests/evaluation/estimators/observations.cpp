#include "tests/evaluation/estimators/observations.h"

#include <algorithm>
#include <random>
#include <set>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "server/render/display_framelet.h"

namespace framelet::bench {
namespace {

constexpr int longest_interval = 1 << (observed_intervals - 1);
constexpr int longest_ago = longest_interval * (observed_refreshes - 1);
constexpr int finest = observed_levels - 1;
constexpr int oracle_side = framelet_side << finest_levels; // samples along the side of a place

/// Index of a level's first framelet among all framelets of a place at one time.
constexpr int first_framelet(int level) {
    int first = 0;
    for (int i = 0; i < level; ++i) {
        first += framelets_at(i);
    }
    return first;
}
constexpr int framelets_in_all = first_framelet(observed_levels);

/// Times at which estimators look: oracle intervals ago, ascending.
std::vector<int> const& observed_times() {
    static std::vector<int> const times = [] {
        std::set<int> all;
        for (int interval = 1; interval <= longest_interval; interval *= 2) {
            for (int i = 0; i < observed_refreshes; ++i) {
                all.insert(i * interval);
            }
        }
        return std::vector<int>(all.begin(), all.end());
    }();
    return times;
}

void append_tiles(Tile place, int level, std::vector<Tile>& tiles) {
    int const finer = level - coarsest_levels;
    if (finer <= 0) {
        tiles.push_back({place.code >> (-2 * finer)});
        return;
    }
    for (int i = 0; i < framelets_at(level); ++i) {
        tiles.push_back({(place.code << (2 * finer)) + static_cast<std::uint32_t>(i)});
    }
}

void write_luma(Framelet const& framelet, float exposure, float* luma) {
    DisplayFramelet const shown = to_display(framelet, exposure);
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        auto const red = static_cast<float>(shown.red[i]), green = static_cast<float>(shown.green[i]);
        luma[i] = (0.2126f * red + 0.7152f * green + 0.0722f * static_cast<float>(shown.blue[i])) / 255;
    }
}

/// Writes the finest framelets of one time into the volume, row by row.
void write_volume(float const* framelets, int time, SampleVolume& volume) {
    constexpr auto side = static_cast<std::size_t>(oracle_side);
    float* const picture = volume.luma.data() + static_cast<std::size_t>(time) * side * side;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        // Framelets follow each other in Morton order, as their samples do: it is one curve.
        picture[morton_y(i) * side + morton_x(i)] = framelets[i];
    }
}

/// Renders all places at one time of the scene. `ago`: oracle intervals before the windows' middle, < 0 after it.
void observe_time(BenchScene& scene, ImagePlane const& plane, int ago, std::vector<Place>& places,
                  std::vector<SampleVolume>& volumes) {
    auto const& times = observed_times();
    auto const slot = std::find(times.begin(), times.end(), ago);
    bool const is_observed = slot != times.end();
    int const oracle_time = oracle_times / 2 - ago;
    bool const in_window = oracle_time >= 0 && oracle_time < oracle_times;
    pose_at(scene, places.front().time - ago / oracle_rate);
    std::vector<Tile> tiles;
    for (Place const& place : places) {
        for (int level = is_observed ? 0 : finest; level < observed_levels; ++level) {
            append_tiles(place.tile, level, tiles);
        }
    }
    std::vector<Framelet> framelets(tiles.size());
    render_framelets(*scene.render_scene, scene.camera, plane, tiles, framelets);
    std::size_t const each = tiles.size() / places.size();
    tbb::parallel_for(std::size_t(0), places.size(), [&](std::size_t p) {
        std::vector<float> luma(each * framelet_samples);
        for (std::size_t i = 0; i < each; ++i) {
            write_luma(framelets[p * each + i], scene.exposure, luma.data() + i * framelet_samples);
        }
        if (is_observed) {
            std::copy(luma.begin(), luma.end(), places[p].luma.begin() + (slot - times.begin()) * std::ssize(luma));
        }
        if (in_window) {
            write_volume(luma.data() + luma.size() - oracle_side * oracle_side, oracle_time, volumes[p]);
        }
    });
}

/// Observes places at the same time, and computes their ideal densities.
void observe_window(BenchScene& scene, ImagePlane const& plane, OracleParameters const& oracle,
                    std::vector<Place>& places) {
    SampleVolume empty{oracle_side, oracle_times, framelet_side, oracle_times / oracle_rate, {}};
    empty.luma.resize(std::size_t(oracle_side) * oracle_side * oracle_times);
    std::vector<SampleVolume> volumes(places.size(), empty);
    for (Place& place : places) {
        place.luma.resize(observed_luma_size());
    }
    for (int const ago : observed_times()) {
        if (ago > oracle_times / 2) {
            observe_time(scene, plane, ago, places, volumes);
        }
    }
    for (int time = 0; time < oracle_times; ++time) {
        observe_time(scene, plane, oracle_times / 2 - time, places, volumes);
    }
    tbb::parallel_for(std::size_t(0), places.size(),
                      [&](std::size_t p) { places[p].ideal = ideal_density(volumes[p], oracle); });
}

} // namespace

std::span<float const> observed_samples(Place const& place, int ago, int level, int index) {
    auto const& times = observed_times();
    auto const slot = std::lower_bound(times.begin(), times.end(), ago);
    FRAMELET_CHECK(slot != times.end() && *slot == ago);
    std::ptrdiff_t const framelet = (slot - times.begin()) * framelets_in_all + first_framelet(level) + index;
    return std::span(place.luma).subspan(static_cast<std::size_t>(framelet) * framelet_samples, framelet_samples);
}

std::size_t observed_luma_size() {
    return observed_times().size() * framelets_in_all * framelet_samples;
}

std::vector<Place> observe_places(BenchScene& scene, ObservationOptions const& options) {
    constexpr double before = longest_ago / oracle_rate, after = oracle_times / 2 / oracle_rate;
    if (scene.duration < before + after) {
        throw InputError("'" + scene.name + "' lasts " + std::to_string(scene.duration) +
                         " s, too short for the oracle: " + std::to_string(before + after) + " s at least");
    }
    ImagePlane const plane(options.viewport);
    std::mt19937 random(options.seed);
    std::uniform_real_distribution<double> seconds(before, scene.duration - after);
    std::uniform_int_distribution<std::uint32_t> code(0, (1u << (2 * plane.pixel_depth())) - 1);
    std::vector<Place> observed;
    for (int window = 0; window < options.windows; ++window) {
        SceneTime const time = seconds(random);
        std::vector<Place> places;
        while (std::ssize(places) < options.places) {
            Tile const tile{(1u << (2 * plane.pixel_depth())) + code(random)};
            PixelRect const rect = plane.tile_rect(tile);
            if (rect.right <= options.viewport.width && rect.bottom <= options.viewport.height) {
                places.push_back({tile, time, {}, {}});
            }
        }
        observe_window(scene, plane, options.oracle, places);
        std::move(places.begin(), places.end(), std::back_inserter(observed));
    }
    return observed;
}

} // namespace framelet::bench
