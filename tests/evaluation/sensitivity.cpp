#include "tests/evaluation/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <nlohmann/json.hpp>

#include "common/picture_writer.h"
#include "tests/evaluation/charts/picture_sheet.h"
#include "tests/evaluation/figure_table.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/methods/tsar.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr int cells = 5; ///< along a side of the grid
constexpr int middle = cells * cells / 2; ///< of the defaults
constexpr float slope_step = 0.5f; ///< in log2 of energy an octave

/// A steeper line through the same energy at the octave of a framelet's mean: finer octaves are tolerated less, as in
/// 004, whose offset is that of the mean.
EnergyTemplate turned(EnergyTemplate line, float steeper) {
    constexpr float mean_octave = 4;
    return {line.offset - steeper * mean_octave, line.slope + steeper};
}

/// What one choice of slopes came to.
struct Cell {
    RateTemplates templates;
    double mse = 0; ///< mean over the run
    double age = 0; ///< likewise, seconds
    RunResult run;
    Picture picture; ///< at half the run, and all below
    Picture tiling;
    std::size_t tiles = 0;
    double samples_per_pixel = 0;
    double mean_rate = 0, least_rate = 0, most_rate = 0; ///< refreshes per second that the tiles ask for
};

/// Tiles with their outlines. Each doubling of the rate is one step brighter, up to a refresh each cycle.
Picture draw_tiling(Tiling const& tiling, std::vector<double> const& rates, double most_rate) {
    Viewport const viewport = tiling.plane.viewport();
    Picture picture(viewport.width, viewport.height);
    for (std::size_t i = 0; i < tiling.tiles.size(); ++i) {
        PixelRect const rect = tiling.plane.tile_rect(tiling.tiles[i]);
        double const octaves = std::log2(most_rate / rates[i]);
        auto const level = static_cast<std::uint8_t>(std::clamp(std::lround(255 - 40 * octaves), 30l, 255l));
        for (int y = rect.top; y < std::min(rect.bottom, picture.height); ++y) {
            for (int x = rect.left; x < std::min(rect.right, picture.width); ++x) {
                bool const outline = x == rect.left || y == rect.top;
                std::uint8_t* const pixel = picture.row(y) + static_cast<std::ptrdiff_t>(x) * 4;
                std::fill_n(pixel, 3, outline ? std::uint8_t(0) : level);
                pixel[3] = 255;
            }
        }
    }
    return picture;
}

void look_at(TsarServer const& server, double fastest, Cell& cell) {
    Tiling const& tiling = server.tiling();
    std::vector<double> rates(tiling.tiles.size());
    tiles_from_field(tiling.tiles, server.density().time, rates);
    cell.tiling = draw_tiling(tiling, rates, fastest);
    Viewport const viewport = tiling.plane.viewport();
    double const pixels = static_cast<double>(viewport.width) * viewport.height;
    cell.tiles = tiling.tiles.size();
    cell.samples_per_pixel = static_cast<double>(cell.tiles * framelet_samples) / pixels;
    double const sum = std::accumulate(rates.begin(), rates.end(), 0.0);
    cell.mean_rate = sum / static_cast<double>(rates.size());
    auto const [least, most] = std::ranges::minmax(rates);
    cell.least_rate = least;
    cell.most_rate = most;
}

Cell run_cell(Subject const& subject, CostTable const& costs, RateTemplates const& templates) {
    RunParameters const& run = subject.run;
    TsarParameters parameters;
    parameters.templates = templates;
    Tsar method(method_setup(run, subject.machine, costs), parameters);
    Cell cell;
    cell.templates = templates;
    std::size_t const times = reference_count(run);
    double const count = static_cast<double>(times);
    cell.run = run_method(*subject.scene, method, run, subject.machine,
                          [&](std::size_t index, Picture const& shown, double age) {
                              cell.mse += mean_squared_error(shown, subject.reference.picture(index)) / count;
                              cell.age += age / count;
                              if (index == times / 2) {
                                  cell.picture = shown;
                                  look_at(method.server(), 4 * run.frames_per_second, cell);
                              }
                          });
    return cell;
}

void draw_sheets(std::vector<Cell> const& grid, std::filesystem::path const& folder, std::string const& scene) {
    std::filesystem::create_directories(folder);
    std::vector<Picture> pictures, tilings;
    for (Cell const& cell : grid) {
        pictures.push_back(cell.picture);
        tilings.push_back(cell.tiling);
    }
    write_png(folder / (scene + "-sensitivity.png"), picture_sheet(pictures, cells, middle));
    write_png(folder / (scene + "-sensitivity-tiling.png"), picture_sheet(tilings, cells, middle));
}

json to_json(EnergyTemplate const& line) {
    return {{"offset", line.offset}, {"slope", line.slope}};
}

json to_json(Cell const& cell) {
    return {{"space", to_json(cell.templates.space)},
            {"time", to_json(cell.templates.time)},
            {"mse", cell.mse},
            {"age_seconds", cell.age},
            {"samples", cell.run.samples},
            {"bytes", cell.run.bytes},
            {"tiles", cell.tiles},
            {"samples_per_pixel", cell.samples_per_pixel},
            {"refreshes_per_second", {{"mean", cell.mean_rate}, {"least", cell.least_rate}, {"most", cell.most_rate}}}};
}

} // namespace

json measure_sensitivity(StudyOptions const& study) {
    FigureTable const table({{"scene", "/scene", -17},
                             {"slope in space", "/space/slope", 14},
                             {"in time", "/time/slope", 7},
                             {"mse", "/mse", 9, 2, 1, true},
                             {"age ms", "/age_seconds", 6, 0, 1e3},
                             {"samples a pixel", "/samples_per_pixel", 15},
                             {"refreshes a second", "/refreshes_per_second/mean", 18, 1}});
    RateTemplates const usual = TsarParameters{}.templates;
    json rows = json::array();
    for (std::filesystem::path const& file : study.scenes) {
        Subject const subject = prepare(file, study);
        std::vector<Cell> grid;
        for (int i = 0; i < cells * cells; ++i) {
            float const space = slope_step * static_cast<float>(cells / 2 - i % cells);
            float const time = slope_step * static_cast<float>(cells / 2 - i / cells);
            grid.push_back(run_cell(subject, study.costs, {turned(usual.space, space), turned(usual.time, time)}));
            rows.push_back(to_json(grid.back()));
            rows.back()["scene"] = subject.scene->name;
            table.print(rows.back());
        }
        if (!study.charts.empty()) {
            draw_sheets(grid, study.charts, subject.scene->name);
        }
    }
    return rows;
}

} // namespace framelet::bench
