#include "tests/evaluation/table.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "tests/evaluation/comparison.h"
#include "tests/evaluation/measures/ratio_summary.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// One method in one run of one scene.
struct Cell {
    std::string method;
    std::size_t scene = 0;
    PublishedRun run;
    std::vector<double> ratios;
    StageSeconds cpu, framed_cpu;

    double published() const { return run.suitable[scene]; }
};

std::vector<std::string> split(std::string const& line) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) {
        fields.push_back(field);
    }
    return fields;
}

PublishedRun parse_run(std::vector<std::string> const& fields) {
    std::vector<double> numbers;
    for (std::string const& field : fields) {
        std::size_t used = 0;
        numbers.push_back(std::stod(field, &used));
        if (used != field.size()) {
            throw std::invalid_argument("not a number");
        }
    }
    PublishedRun run{static_cast<int>(numbers.at(0)),
                     static_cast<int>(numbers.at(1)),
                     static_cast<int>(numbers.at(2)),
                     {numbers.begin() + 3, numbers.end()}};
    auto const is_share = [](double per_cent) { return per_cent >= 0 && per_cent <= 100; };
    if (run.batch < 1 || run.side < 16 || !std::ranges::all_of(run.suitable, is_share)) {
        throw std::invalid_argument("out of range");
    }
    return run;
}

json seconds_of(StageSeconds const& cpu) {
    return {{"server", cpu.server()}, {"viewer", cpu.viewer()}};
}

json to_json(Cell const& cell, std::string const& scene) {
    RatioSummary const summary = summarise_ratios(cell.ratios);
    return {{"method", cell.method},
            {"scene", scene},
            {"run", cell.run.number},
            {"batch", cell.run.batch},
            {"side", cell.run.side},
            {"published_percentile", cell.published()},
            {"suitable_percentile", summary.suitable},
            {"median_ratio", summary.median},
            {"cpu_seconds", seconds_of(cell.cpu)},
            {"framed_cpu_seconds", seconds_of(cell.framed_cpu)},
            {"ratios", cell.ratios}};
}

void print_head() {
    std::printf("%-11s %3s %5s %5s  %-17s %10s %7s %8s %18s %18s\n", "method", "run", "batch", "side", "scene",
                "published %", "suit. %", "median", "CPU s srv + view", "framed srv + view");
}

void print(Cell const& cell, std::string const& scene) {
    RatioSummary const summary = summarise_ratios(cell.ratios);
    std::printf("%-11s %3d %5d %5d  %-17s %10.0f %7.0f %9.3f %9.2f + %6.3f %9.2f + %6.3f\n", cell.method.c_str(),
                cell.run.number, cell.run.batch, cell.run.side, scene.c_str(), cell.published(), summary.suitable,
                summary.median, cell.cpu.server(), cell.cpu.viewer(), cell.framed_cpu.server(),
                cell.framed_cpu.viewer());
    std::fflush(stdout); // a table takes an hour: whoever reads a pipe wants to see it grow
}

/// All runs of one scene, picture by picture size, since the runs of one size share reference and framed. A method
/// without batches does the same in all of them and is run once.
std::vector<Cell> run_scene(PublishedTable const& table, std::size_t scene_index, BenchScene& scene,
                            StudyOptions options) {
    std::vector<Cell> cells;
    std::map<int, std::vector<PublishedRun>> runs_by_side;
    for (PublishedRun const& run : table.runs) {
        runs_by_side[run.side].push_back(run);
    }
    RivalParts const rivals = options.run.rivals;
    for (auto const& [side, runs] : runs_by_side) {
        options.run.viewport = {side, side};
        options.run.counting = Counting::total;
        Reference const reference = reference_of(scene, options);
        double const machine = machine_factor(scene, options.run, options.costs);
        auto const record = [&](std::string const& method, int batch) {
            options.run.batch_framelets = static_cast<std::size_t>(batch);
            // What all are divided by is what 004 divided by.
            options.run.rivals = method == "framed" ? plain_rivals : rivals;
            return record_method(scene, reference, method, options.run, machine, options.costs);
        };
        MethodRecord const framed = record("framed", 0);
        for (std::string const& method : options.methods) {
            std::optional<MethodRecord> recorded;
            for (PublishedRun const& run : runs) {
                if (!recorded || has_batches(method)) {
                    recorded = record(method, run.batch);
                }
                cells.push_back(
                    {method, scene_index, run, error_ratios(*recorded, framed), recorded->run.cpu, framed.run.cpu});
                print(cells.back(), scene.name);
            }
        }
    }
    return cells;
}

/// As Table 7.2 is set: a row a run, in each scene ours beside the published.
void print_table(PublishedTable const& table, std::vector<Cell> const& cells, std::string const& method) {
    std::printf("\n%s: suitable percentile (published)\n%3s %5s %5s", method.c_str(), "run", "batch", "side");
    for (std::string const& scene : table.scenes) {
        std::printf(" %17s", scene.c_str());
    }
    double ours = 0, theirs = 0, count = 0;
    for (PublishedRun const& run : table.runs) {
        std::printf("\n%3d %5d %5d", run.number, run.batch, run.side);
        for (std::size_t scene = 0; scene < table.scenes.size(); ++scene) {
            for (Cell const& cell : cells) {
                if (cell.method == method && cell.scene == scene && cell.run.number == run.number) {
                    double const suitable = summarise_ratios(cell.ratios).suitable;
                    std::printf(" %11.0f (%3.0f)", suitable, cell.published());
                    ours += suitable;
                    theirs += cell.published();
                    count += 1;
                }
            }
        }
    }
    std::printf("\nmean %.0f (%.0f)\n", ours / count, theirs / count);
}

} // namespace

PublishedTable read_published_table(std::filesystem::path const& file) {
    std::ifstream stream(file);
    if (!stream) {
        throw InputError("cannot read the published table '" + file.string() + "'");
    }
    PublishedTable table;
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        if (line.empty() || line.front() == '#') {
            continue;
        }
        std::vector<std::string> const fields = split(line);
        if (table.scenes.empty() && fields.size() > 3 && fields.front() == "run") {
            table.scenes.assign(fields.begin() + 3, fields.end());
            continue;
        }
        try {
            if (table.scenes.empty() || fields.size() != table.scenes.size() + 3) {
                throw std::invalid_argument("another number of columns");
            }
            table.runs.push_back(parse_run(fields));
        } catch (std::logic_error const&) { // what stod and the checks above throw
            throw InputError("'" + file.string() + "', line " + std::to_string(number) +
                             ": expected a run's number, its batch, its side and a percentile for each scene");
        }
    }
    if (table.runs.empty()) {
        throw InputError("'" + file.string() + "' has no run");
    }
    return table;
}

PublishedTable part_of(PublishedTable const& table, std::vector<int> const& runs,
                       std::vector<std::string> const& scenes) {
    for (int const run : runs) {
        if (std::ranges::find(table.runs, run, &PublishedRun::number) == table.runs.end()) {
            throw InputError("the published table has no run " + std::to_string(run));
        }
    }
    for (std::string const& scene : scenes) {
        if (std::ranges::find(table.scenes, scene) == table.scenes.end()) {
            throw InputError("the published table has no scene '" + scene + "'");
        }
    }
    PublishedTable part;
    for (PublishedRun const& run : table.runs) {
        if (runs.empty() || std::ranges::find(runs, run.number) != runs.end()) {
            part.runs.push_back({run.number, run.batch, run.side, {}});
        }
    }
    for (std::size_t i = 0; i < table.scenes.size(); ++i) {
        if (scenes.empty() || std::ranges::find(scenes, table.scenes[i]) != scenes.end()) {
            part.scenes.push_back(table.scenes[i]);
            for (PublishedRun& run : part.runs) {
                run.suitable.push_back(std::ranges::find(table.runs, run.number, &PublishedRun::number)->suitable[i]);
            }
        }
    }
    return part;
}

json run_table(PublishedTable const& table, std::filesystem::path const& folder, StudyOptions const& study) {
    StudyOptions options = study;
    std::erase(options.methods, "framed"); // what the others are divided by
    std::vector<Cell> cells;
    print_head();
    for (std::size_t i = 0; i < table.scenes.size(); ++i) {
        auto const scene = load_bench_scene(folder / (table.scenes[i] + ".glb"));
        auto const of_scene = run_scene(table, i, *scene, options);
        cells.insert(cells.end(), of_scene.begin(), of_scene.end());
    }
    json result{{"counting", "total"},
                {"seconds", options.run.seconds},
                {"reference_rate", options.run.reference_rate},
                {"samples_per_pixel_and_second", options.run.frames_per_second},
                {"seed", options.run.seed}};
    for (Cell const& cell : cells) {
        result["cells"].push_back(to_json(cell, table.scenes[cell.scene]));
    }
    for (std::string const& method : options.methods) {
        print_table(table, cells, method);
    }
    return result;
}

} // namespace framelet::bench
