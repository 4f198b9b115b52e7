#include "tests/evaluation/estimators/estimator_verbs.h"

#include <cstdio>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/estimators/agreement.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr std::size_t quick_scenes = 2;

std::vector<Place> observe(EstimatorStudy const& study) {
    std::vector<Place> places;
    std::size_t const count = study.quick ? std::min(quick_scenes, study.scenes.size()) : study.scenes.size();
    ObservationOptions options = study.observation;
    if (study.quick) {
        options.windows = std::min(options.windows, 3);
    }
    for (std::size_t i = 0; i < count; ++i) {
        auto const scene = load_bench_scene(study.scenes[i]);
        std::fprintf(stderr, "oracle: %s, %zu of %zu\n", scene->name.c_str(), i + 1, count);
        auto found = observe_places(*scene, options);
        std::move(found.begin(), found.end(), std::back_inserter(places));
    }
    return places;
}

/// Nanoseconds a framelet of one block with a history, median of `rounds` over all places.
double cost_of(ErrorEstimator const& estimator, std::span<Place const> places, int rounds) {
    std::vector<ErrorHistory> histories(places.size());
    RateError error;
    auto const pass = [&](int ago) {
        for (std::size_t i = 0; i < places.size(); ++i) {
            estimator.estimate(observed_samples(places[i], ago, coarsest_levels, 0), histories[i],
                               static_cast<float>(seconds_at(0)), estimator.templates, {&error, 1});
        }
    };
    pass(1);
    std::vector<double> ns;
    for (int round = 0; round < rounds; ++round) {
        ns.push_back(1e9 * seconds_of([&] { pass(round % 2); }) / static_cast<double>(places.size()));
    }
    return median(ns);
}

json to_json(Agreement const& agreement) {
    return {{"rank", agreement.rank},
            {"rank_at_rate", agreement.rank_at_rate},
            {"signs", agreement.signs.all},
            {"balanced_signs", agreement.signs.balanced}};
}

void print_row(char const* name, std::string const& cost, Agreement const& space, Agreement const& time) {
    std::printf("%-12s %8s", name, cost.c_str());
    for (Agreement const& axis : {space, time}) {
        std::printf("   %6.3f  %6.3f  %5.1f%%  %5.1f%%", axis.rank, axis.rank_at_rate, 100 * axis.signs.all,
                    100 * axis.signs.balanced);
    }
    std::printf("\n");
}

json places_of(std::vector<Place> const& places) {
    json result = json::array();
    for (Place const& place : places) {
        result.push_back({{"tile", place.tile.code},
                          {"time", place.time},
                          {"samples_per_pixel", place.ideal.samples_per_pixel()},
                          {"refreshes_per_second", place.ideal.refreshes_per_second()}});
    }
    return result;
}

json parameters_of(EstimatorStudy const& study) {
    return {{"share", study.observation.oracle.share},
            {"floor", study.observation.oracle.floor},
            {"seed", study.observation.seed}};
}

} // namespace

void add_estimator_options(CLI::App& verb, EstimatorStudy& study) {
    verb.add_option("--windows", study.observation.windows, "Times of each scene")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    verb.add_option("--places", study.observation.places, "Places at each time")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    verb.add_option("--share", study.observation.oracle.share, "Of a place's energy that its ideal density captures")
        ->check(CLI::Range(0.01, 0.9999))
        ->capture_default_str();
    verb.add_option("--floor", study.observation.oracle.floor, "Mean square of luma that need not be captured")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
}

json compare_estimators(EstimatorStudy const& study) {
    std::vector<Place> const places = observe(study);
    std::printf("%zu places, ideal density captures %g of the energy\n\n", places.size(),
                study.observation.oracle.share);
    std::printf("                 ns a   space                              time\n");
    std::printf("estimator    framelet     rank at rate   signs balanced     rank at rate   signs balanced\n");
    json result = parameters_of(study);
    Curves chart{.title = "Error estimators against the oracle, space and time",
                 .x_title = "cost [ns a framelet]",
                 .y_title = "rank correlation",
                 .curves = {}};
    Verdicts verdicts;
    for (ErrorEstimator const& estimator : error_estimators) {
        verdicts = judge(estimator, estimator.templates, places);
        Agreement const space = agreement(verdicts.space), time = agreement(verdicts.time);
        double const cost = cost_of(estimator, places, study.quick ? 101 : 301);
        char text[32];
        std::snprintf(text, sizeof(text), "%.0f", cost);
        print_row(estimator.name, text, space, time);
        result["estimators"][estimator.name] = {{"ns", cost}, {"space", to_json(space)}, {"time", to_json(time)}};
        chart.curves.push_back({estimator.name, {cost, cost}, {space.rank, time.rank}});
    }
    Agreement const space = agreement_of_rate_alone(verdicts.space, RateOrder::ascending);
    Agreement const time = agreement_of_rate_alone(verdicts.time, RateOrder::descending);
    print_row("rate alone", "", space, time);
    result["rate_alone"] = {{"space", to_json(space)}, {"time", to_json(time)}};
    result["places"] = places_of(places);
    if (!study.charts.empty()) {
        std::filesystem::create_directories(study.charts);
        draw(chart, study.charts / "estimators");
    }
    return result;
}

} // namespace framelet::bench
