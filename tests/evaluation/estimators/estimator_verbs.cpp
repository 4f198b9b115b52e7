#include "tests/evaluation/estimators/estimator_verbs.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "tests/evaluation/estimators/agreement.h"
#include "tests/evaluation/figure_table.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr std::size_t quick_scenes = 2;

std::vector<Place> observe(StudyOptions const& study, ObservationOptions options, bool quick) {
    std::vector<Place> places;
    std::size_t const count = quick ? std::min(quick_scenes, study.scenes.size()) : study.scenes.size();
    options.seed = static_cast<std::uint32_t>(study.run.seed);
    for (std::size_t i = 0; i < count; ++i) {
        auto const scene = load_bench_scene(study.scenes[i]);
        std::fprintf(stderr, "oracle: %s, %zu of %zu\n", scene->name.c_str(), i + 1, count);
        auto found = observe_places(*scene, options);
        std::move(found.begin(), found.end(), std::back_inserter(places));
    }
    return places;
}

/// Cost of an estimator: nanoseconds for a framelet of one block with a history, median of `rounds` over all places.
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

} // namespace

json compare_estimators(StudyOptions const& study, ObservationOptions const& observation, bool quick) {
    std::vector<Place> const places = observe(study, observation, quick);
    std::printf("%zu places, ideal density captures %g of the energy\n\n", places.size(), observation.oracle.share);
    FigureTable const table({{"estimator", "/name", -12},
                             {"ns a framelet", "/ns", 13, 0},
                             {"space: rank", "/space/rank", 11, 3},
                             {"at rate", "/space/rank_at_rate", 7, 3},
                             {"signs %", "/space/signs", 7, 1, 100},
                             {"balanced", "/space/balanced_signs", 8, 1, 100},
                             {"time: rank", "/time/rank", 10, 3},
                             {"at rate", "/time/rank_at_rate", 7, 3},
                             {"signs %", "/time/signs", 7, 1, 100},
                             {"balanced", "/time/balanced_signs", 8, 1, 100}});
    json rows = json::array();
    auto const add = [&](char const* name, json const& ns, Agreement const& space, Agreement const& time) {
        rows.push_back({{"name", name}, {"ns", ns}, {"space", to_json(space)}, {"time", to_json(time)}});
        table.print(rows.back());
    };
    Verdicts verdicts;
    for (ErrorEstimator const& estimator : error_estimators) {
        verdicts = judge(estimator, estimator.templates, places);
        add(estimator.name, cost_of(estimator, places, quick ? 101 : 301), agreement(verdicts.space),
            agreement(verdicts.time));
    }
    add("rate alone", {}, agreement_of_rate_alone(verdicts.space, RateOrder::ascending),
        agreement_of_rate_alone(verdicts.time, RateOrder::descending));
    return {{"share", observation.oracle.share},
            {"floor", observation.oracle.floor},
            {"seed", study.run.seed},
            {"estimators", rows}};
}

} // namespace framelet::bench
