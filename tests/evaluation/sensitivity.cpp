#include "tests/evaluation/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <nlohmann/json.hpp>

#include "common/files/picture_writer.h"
#include "tests/evaluation/charts/picture_sheet.h"
#include "tests/evaluation/figure_table.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/methods/tsar.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr int cells = 5; ///< number of slopes along a side of the grid
constexpr int middle = cells * cells / 2; ///< index of the cell with the default slopes
constexpr float slope_step = 0.5f; ///< step from slope to slope, log2 of energy an octave

/// A steeper line through the same energy at the octave of a framelet's mean: finer octaves are tolerated less, as in
/// [Stephens 2011], where the offset is that of the mean.
EnergyTemplate turned(EnergyTemplate line, float steeper) {
    constexpr float mean_octave = 4;
    return {line.offset - steeper * mean_octave, line.slope + steeper};
}

/// Draws the tiles with their outlines. Each doubling of the refresh rate is one step brighter, up to `most_rate`.
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

/// Figures of the tiling that the server has arrived at with its slopes by now.
json tiling_figures(TsarServer const& server, std::vector<double> const& rates) {
    Tiling const& tiling = server.tiling();
    Viewport const viewport = tiling.plane.viewport();
    double const pixels = static_cast<double>(viewport.width) * viewport.height;
    double const sum = std::accumulate(rates.begin(), rates.end(), 0.0);
    auto const [least, most] = std::ranges::minmax(rates);
    return {{"tiles", tiling.tiles.size()},
            {"samples_per_pixel", static_cast<double>(tiling.tiles.size() * framelet_samples) / pixels},
            {"refreshes_per_second",
             {{"mean", sum / static_cast<double>(rates.size())}, {"least", least}, {"most", most}}}};
}

json to_json(EnergyTemplate const& line) {
    return {{"offset", line.offset}, {"slope", line.slope}};
}

/// Runs one choice of slopes. The picture shown at half the run goes to `pictures`, and its tiling to `tilings`.
json run_cell(Subject const& subject, CostTable const& costs, RateTemplates const& templates,
              std::vector<Picture>& pictures, std::vector<Picture>& tilings) {
    RunParameters const& run = subject.run;
    TsarParameters parameters;
    parameters.templates = templates;
    Tsar method(method_setup(run, subject.machine, costs), parameters);
    std::size_t const times = reference_count(run);
    double mse = 0, age_seconds = 0;
    json row;
    RunResult const result = run_method(
        *subject.scene, method, run, subject.machine, [&](std::size_t index, Picture const& shown, double age) {
            mse += mean_squared_error(shown, subject.reference.picture(index)) / static_cast<double>(times);
            age_seconds += age / static_cast<double>(times);
            if (index == times / 2) {
                Tiling const& tiling = method.server().tiling();
                std::vector<double> rates(tiling.tiles.size());
                tiles_from_field(tiling.tiles, method.server().density().time, rates);
                row = tiling_figures(method.server(), rates);
                pictures.push_back(shown);
                tilings.push_back(draw_tiling(tiling, rates, 4 * run.frames_per_second));
            }
        });
    row.update({{"scene", subject.scene->name},
                {"space", to_json(templates.space)},
                {"time", to_json(templates.time)},
                {"mse", mse},
                {"age_seconds", age_seconds},
                {"samples", result.samples},
                {"bytes", result.bytes}});
    return row;
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
        std::vector<Picture> pictures, tilings;
        for (int i = 0; i < cells * cells; ++i) {
            float const space = slope_step * static_cast<float>(cells / 2 - i % cells);
            float const time = slope_step * static_cast<float>(cells / 2 - i / cells);
            RateTemplates const templates{turned(usual.space, space), turned(usual.time, time)};
            table.print(rows.emplace_back(run_cell(subject, study.costs, templates, pictures, tilings)));
        }
        if (!study.charts.empty()) {
            std::filesystem::create_directories(study.charts);
            std::string const stem = subject.scene->name + "-sensitivity";
            write_png(study.charts / (stem + ".png"), picture_sheet(pictures, cells, middle));
            write_png(study.charts / (stem + "-tiling.png"), picture_sheet(tilings, cells, middle));
        }
    }
    return rows;
}

} // namespace framelet::bench
