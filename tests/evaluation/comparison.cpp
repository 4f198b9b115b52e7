#include "tests/evaluation/comparison.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <numeric>
#include <utility>

#include <nlohmann/json.hpp>
#include <tbb/task_group.h>

#include "common/error.h"
#include "tests/evaluation/figure_table.h"
#include "tests/evaluation/measures/ratio_summary.h"
#include "tests/evaluation/rival_choice.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// Mean squared errors below this are due to rounding to bytes.
constexpr double least_mse = 1e-9;

json series(MethodRecord const& record, double Measures::*value) {
    json list = json::array();
    for (Measures const& measures : record.measures) {
        list.push_back(measures.*value);
    }
    return list;
}

template <class Element, class Value>
double mean_of(std::vector<Element> const& elements, Value&& value) {
    double sum = 0;
    for (Element const& element : elements) {
        sum += std::invoke(value, element);
    }
    return elements.empty() ? 0 : sum / static_cast<double>(elements.size());
}

MethodRecord record_run(BenchScene& scene, Reference const& reference, std::string const& name,
                        RunParameters const& parameters, double machine, CostTable const& costs) {
    std::size_t const times = reference_count(parameters);
    FRAMELET_CHECK(reference.size() >= times);
    MethodRecord record;
    record.method = name;
    record.rivals = parameters.rivals;
    record.measures.resize(times);
    record.ages.resize(times);
    record.unsteadiness.resize(times);
    std::array<Picture, 3> last;
    auto const method = make_method(name, method_setup(parameters, machine, costs));
    tbb::task_group measuring;
    record.run =
        run_method(scene, *method, parameters, machine, [&](std::size_t index, Picture const& shown, double age) {
            record.ages[index] = age;
            if (index == times / 2) {
                record.sample = shown;
            }
            last = {std::move(last[1]), std::move(last[2]), shown};
            measuring.run([&record, &reference, index, last] {
                record.measures[index] = measure(last[2], reference.picture(index));
                if (index >= 2) {
                    record.unsteadiness[index] = unsteadiness(
                        last, {reference.picture(index - 2), reference.picture(index - 1), reference.picture(index)});
                }
            });
        });
    measuring.wait();
    return record;
}

} // namespace

MethodRecord record_method(BenchScene& scene, Reference const& reference, std::string const& name,
                           RunParameters const& parameters, double machine, CostTable const& costs) {
    std::vector<MethodRecord> records;
    std::vector<double> errors;
    for (RivalParts const& choice : rival_choices(name, parameters.rivals)) {
        RunParameters chosen = parameters;
        chosen.rivals = choice;
        records.push_back(record_run(scene, reference, name, chosen, machine, costs));
        errors.push_back(mean_mse(records.back()));
    }
    return std::move(records[best_choice(errors)]);
}

Comparison compare_methods(BenchScene& scene, Reference const& reference, std::vector<std::string> const& methods,
                           RunParameters const& parameters, CostTable const& costs) {
    Comparison comparison;
    comparison.scene = scene.name;
    comparison.parameters = parameters;
    comparison.machine = machine_factor(scene, parameters, costs);
    comparison.turn = scene.turn.degrees_per_second;
    std::size_t const times = reference_count(parameters);
    comparison.reference_sample = reference.picture(times / 2);
    for (std::string const& name : methods) {
        comparison.records.push_back(record_method(scene, reference, name, parameters, comparison.machine, costs));
    }
    return comparison;
}

MethodRecord const* find_framed(Comparison const& comparison) {
    auto const found = std::ranges::find(comparison.records, "framed", &MethodRecord::method);
    return found == comparison.records.end() ? nullptr : &*found;
}

std::vector<double> error_ratios(MethodRecord const& method, MethodRecord const& framed) {
    FRAMELET_CHECK(method.measures.size() == framed.measures.size());
    std::vector<double> ratios;
    for (std::size_t i = 0; i < method.measures.size(); ++i) {
        ratios.push_back(std::max(method.measures[i].mse, least_mse) / std::max(framed.measures[i].mse, least_mse));
    }
    return ratios;
}

ErrorSeries error_series(MethodRecord const& record, RunParameters const& parameters) {
    ErrorSeries series{record.method, {}, {}, record.run.displayed};
    for (std::size_t i = 0; i < record.measures.size(); ++i) {
        series.seconds.push_back(reference_time(parameters, i));
        series.mse.push_back(record.measures[i].mse);
    }
    return series;
}

double mean_unsteadiness(MethodRecord const& record) {
    std::size_t const counted = record.unsteadiness.size() - std::min<std::size_t>(2, record.unsteadiness.size());
    double const sum = std::accumulate(record.unsteadiness.begin(), record.unsteadiness.end(), 0.0);
    return counted > 0 ? sum / static_cast<double>(counted) : 0;
}

double mean_mse(MethodRecord const& record) {
    return mean_of(record.measures, &Measures::mse);
}

json to_json(Comparison const& comparison) {
    RunParameters const& p = comparison.parameters;
    json result{{"scene", comparison.scene},
                {"viewport", {p.viewport.width, p.viewport.height}},
                {"start", p.start},
                {"seconds", p.seconds},
                {"reference_rate", p.reference_rate},
                {"samples_per_pixel_and_second", p.frames_per_second},
                {"counting", p.counting == Counting::total ? "total" : "server"},
                {"seed", p.seed},
                {"machine_factor", comparison.machine},
                {"turn_degrees_per_second", comparison.turn},
                {"link", {{"bits_per_second", p.link.bits_per_second}, {"delay_seconds", p.link.delay_seconds}}}};
    MethodRecord const* const framed = find_framed(comparison);
    for (MethodRecord const& record : comparison.records) {
        json entry{{"method", record.method},
                   {"mean",
                    {{"mse", mean_mse(record)},
                     {"psnr", mean_of(record.measures, &Measures::psnr)},
                     {"ssim", mean_of(record.measures, &Measures::ssim)},
                     {"flip", mean_of(record.measures, &Measures::flip)},
                     {"age", mean_of(record.ages, std::identity())},
                     {"unsteadiness", mean_unsteadiness(record)}}},
                   {"cpu_seconds",
                    {{"render", record.run.cpu.render},
                     {"response", record.run.cpu.response},
                     {"encode", record.run.cpu.encode},
                     {"decode", record.run.cpu.decode},
                     {"reconstruct", record.run.cpu.reconstruct},
                     {"server", record.run.cpu.server()},
                     {"viewer", record.run.cpu.viewer()}}},
                   {"samples", record.run.samples},
                   {"bytes", record.run.bytes},
                   {"bytes_per_second", static_cast<double>(record.run.bytes) / p.seconds},
                   {"messages", record.run.messages},
                   {"mean_delay_seconds", record.run.mean_delay},
                   {"displayed", record.run.displayed},
                   {"age", record.ages},
                   {"unsteadiness", record.unsteadiness},
                   {"mse", series(record, &Measures::mse)},
                   {"ssim", series(record, &Measures::ssim)},
                   {"flip", series(record, &Measures::flip)}};
        if (has_spacing(record.method)) {
            entry["spacing"] = record.rivals.spacing;
        }
        if (has_margin(record.method)) {
            entry["margin"] = record.rivals.margin;
        }
        if (framed) {
            RatioSummary const ratio = summarise_ratios(error_ratios(record, *framed));
            entry["ratio_to_framed"] = {{"median", ratio.median}, {"suitable_percentile", ratio.suitable}};
        }
        result["methods"].push_back(entry);
    }
    return result;
}

void print(Comparison const& comparison) {
    RunParameters const& p = comparison.parameters;
    std::printf("%s, %dx%d, %g s from %g s on, a machine of %g samples a pixel and second\n", comparison.scene.c_str(),
                p.viewport.width, p.viewport.height, p.seconds, p.start, p.frames_per_second);
    if (p.link.bits_per_second > 0 || p.link.delay_seconds > 0) {
        std::printf("link %.3g Mbit/s, %.0f ms each way\n", p.link.bits_per_second / 1e6, 1e3 * p.link.delay_seconds);
    }
    if (comparison.turn > 0) {
        std::printf("camera turning %g degrees a second\n", comparison.turn);
    }
    FigureTable const table({{"method", "/method", -17},
                             {"mse", "/mean/mse", 10, 3, 1, true},
                             {"psnr", "/mean/psnr", 6},
                             {"ssim", "/mean/ssim", 6, 4},
                             {"flip", "/mean/flip", 6, 4},
                             {"age ms", "/mean/age", 7, 0, 1e3},
                             {"ratio", "/ratio_to_framed/median", 8, 3},
                             {"suit. %", "/ratio_to_framed/suitable_percentile", 7, 0},
                             {"CPU s", "/cpu_seconds/server", 7, 3},
                             {"viewer s", "/cpu_seconds/viewer", 9, 4},
                             {"kB/s", "/bytes_per_second", 9, 1, 1e-3},
                             {"spacing", "/spacing", 7, 0},
                             {"margin", "/margin", 6, 3}});
    json const figures = to_json(comparison);
    for (json const& method : figures["methods"]) {
        table.print(method);
    }
}

} // namespace framelet::bench
