#include "tests/evaluation/link_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>

#include <nlohmann/json.hpp>

#include "tests/evaluation/charts/heat_table.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/shown_pictures.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr char const* own = "framelet";
constexpr std::array beside{"framed+h264", "framed+jpeg", "framed+warp"};
/// Those of `beside` that the goal is about.
constexpr std::size_t judged = 2;
constexpr double faster = 4; ///< than the server of the table, where that may be what is missing
/// Errors below this are those of rounding to bytes.
constexpr double least_mse = 1e-9;

struct Link {
    double megabits = 0, round_trip_ms = 0;

    LinkParameters parameters() const {
        return {.bits_per_second = 1e6 * megabits, .delay_seconds = 0.5e-3 * round_trip_ms};
    }
    std::string name() const {
        char text[64];
        std::snprintf(text, sizeof(text), "%g / %g", megabits, round_trip_ms);
        return text;
    }
};

using Ratios = std::array<double, beside.size()>;

struct Cell {
    Link link;
    Ratios ratios{};
    double psnr = 0; ///< of the project's mean error
    /// Of the judged methods the worse one, where the goal is missed: without the link's limit, with a faster server.
    double unlimited = NAN, on_faster = NAN;

    double worst() const { return *std::max_element(ratios.begin(), ratios.begin() + judged); }
};

/// One scene, whichever link and server.
class SceneTable {
public:
    SceneTable(BenchScene& scene, StudyOptions const& options)
        : scene_(scene), options_(options),
          truth_(read_pictures(reference_of(scene, options), reference_count(options.run))),
          machine_(machine_factor(scene, options.run, options.costs)) {}

    Cell cell(Link const& link, double goal) {
        Cell result{link, {}, 0, NAN, NAN};
        std::vector<double> const mine = errors(own, link.parameters(), 1);
        for (double const error : mine) {
            result.psnr += error / static_cast<double>(mine.size());
        }
        result.psnr = psnr_from_mse(result.psnr);
        for (std::size_t i = 0; i < beside.size(); ++i) {
            result.ratios[i] = median_ratio(mine, errors(beside[i], link.parameters(), 1));
        }
        if (result.worst() > goal) {
            auto const worst = static_cast<std::size_t>(
                std::max_element(result.ratios.begin(), result.ratios.begin() + judged) - result.ratios.begin());
            Link const unlimited{0, link.round_trip_ms};
            result.unlimited = ratio(beside[worst], unlimited.parameters(), 1);
            result.on_faster = ratio(beside[worst], link.parameters(), faster);
        }
        return result;
    }

private:
    double ratio(char const* method, LinkParameters const& link, double speed) {
        return median_ratio(errors(own, link, speed), errors(method, link, speed));
    }

    std::vector<double> errors(char const* method, LinkParameters const& link, double speed) {
        RunParameters parameters = options_.run;
        parameters.link = link;
        parameters.frames_per_second *= speed;
        return errors_of(show_best(scene_, method, parameters, machine_ / speed, options_.costs, truth_).pictures,
                         truth_);
    }

    static double median_ratio(std::vector<double> const& mine, std::vector<double> const& other) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < mine.size(); ++i) {
            ratios.push_back(std::max(mine[i], least_mse) / std::max(other[i], least_mse));
        }
        return median_of(std::move(ratios));
    }

    BenchScene& scene_;
    StudyOptions const& options_;
    std::vector<Picture> const truth_;
    double const machine_;
};

/// Which of the two would be enough by itself.
char const* missing(Cell const& cell, double goal) {
    bool const link = cell.unlimited <= goal;
    bool const server = cell.on_faster <= goal;
    return link && server ? "link or server" : link ? "link" : server ? "server" : "neither";
}

void print(std::string const& scene, Cell const& cell, double goal) {
    std::printf("%-18s %7g %7g %7.1f", scene.c_str(), cell.link.megabits, cell.link.round_trip_ms, cell.psnr);
    for (double const ratio : cell.ratios) {
        std::printf(" %12.2f", ratio);
    }
    if (cell.worst() > goal) {
        std::printf("   > %g: unlimited link %.2f, %gx server %.2f: %s", goal, cell.unlimited, faster, cell.on_faster,
                    missing(cell, goal));
    }
    std::printf("\n");
    std::fflush(stdout);
}

json to_json(Cell const& cell, double goal) {
    json result{{"megabits", cell.link.megabits}, {"round_trip_ms", cell.link.round_trip_ms}, {"psnr", cell.psnr}};
    for (std::size_t i = 0; i < beside.size(); ++i) {
        result["ratio"][beside[i]] = cell.ratios[i];
    }
    if (cell.worst() > goal) {
        result["unlimited_link"] = cell.unlimited;
        result["faster_server"] = cell.on_faster;
        result["missing"] = missing(cell, goal);
    }
    return result;
}

} // namespace

json link_table(LinkTableOptions const& table, StudyOptions const& options) {
    std::vector<Link> links;
    for (double const megabits : table.megabits) {
        for (double const round_trip : table.round_trips_ms) {
            links.push_back({megabits, round_trip});
        }
    }
    std::array<HeatTable, beside.size()> charts;
    for (std::size_t i = 0; i < beside.size(); ++i) {
        charts[i].title = std::string("median of MSE(") + own + ") / MSE(" + beside[i] + ")";
        charts[i].x_title = "link [Mbit/s] / round trip [ms]";
        charts[i].goal = i < judged ? table.goal : 0;
        std::ranges::transform(links, std::back_inserter(charts[i].columns), &Link::name);
    }
    std::printf("%-18s %7s %7s %7s", "scene", "Mbit/s", "RTT ms", "PSNR");
    for (char const* const method : beside) {
        std::printf(" %12s", method);
    }
    std::printf("\n");
    json result = json::object();
    std::size_t missed = 0;
    for (std::filesystem::path const& file : table.scenes) {
        auto const scene = load_bench_scene(file);
        SceneTable rows(*scene, options);
        for (HeatTable& chart : charts) {
            chart.rows.push_back(scene->name);
            chart.values.emplace_back();
        }
        for (Link const& link : links) {
            Cell const cell = rows.cell(link, table.goal);
            print(scene->name, cell, table.goal);
            missed += cell.worst() > table.goal ? 1 : 0;
            result[scene->name].push_back(to_json(cell, table.goal));
            for (std::size_t i = 0; i < beside.size(); ++i) {
                charts[i].values.back().push_back(cell.ratios[i]);
            }
        }
    }
    std::printf("%zu of %zu above %g\n", missed, links.size() * table.scenes.size(), table.goal);
    if (!options.charts.empty()) {
        std::filesystem::create_directories(options.charts);
        for (std::size_t i = 0; i < beside.size(); ++i) {
            draw(charts[i], options.charts / (std::string("links-") + beside[i]));
        }
    }
    return result;
}

} // namespace framelet::bench
