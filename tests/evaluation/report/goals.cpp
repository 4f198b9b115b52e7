#include "tests/evaluation/report/goals.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "tests/evaluation/report/live_tables.h"
#include "tests/evaluation/report/report_text.h"
#include "tests/evaluation/scene_events.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr double display_rate = 60;

/// A figure of one scene, run or cell.
struct Value {
    std::string of;
    double value = 0;
};

enum class Bound { at_most, at_least };

bool holds(Bound bound, double value, double goal) {
    return bound == Bound::at_most ? value <= goal : value >= goal;
}

std::string with_decimals(int decimals, double value) {
    return printed("%.*f", decimals, value);
}

/// A goal that each value keeps the bound: how many do, and which one is farthest from it.
Goal all_of(std::string what, std::vector<Value> const& values, Bound bound, double goal, int decimals) {
    Goal result{std::move(what), (bound == Bound::at_most ? "<= " : ">= ") + printed("%g", goal) + " in each",
                "not measured", false};
    if (values.empty()) {
        return result;
    }
    auto const kept = std::ranges::count_if(values, [&](Value const& v) { return holds(bound, v.value, goal); });
    Value const& worst = bound == Bound::at_most ? *std::ranges::max_element(values, {}, &Value::value)
                                                 : *std::ranges::min_element(values, {}, &Value::value);
    std::vector<double> plain;
    std::ranges::transform(values, std::back_inserter(plain), &Value::value);
    result.figure = printed("%zd of %zu; median ", kept, values.size()) + with_decimals(decimals, median(plain)) +
                    ", worst " + with_decimals(decimals, worst.value) + " (`" + worst.of + "`)";
    result.met = kept == std::ssize(values);
    return result;
}

Goal median_of(std::string what, std::vector<Value> const& values, double goal) {
    Goal result{std::move(what), printed("<= %g", goal), "not measured", false};
    if (!values.empty()) {
        std::vector<double> plain;
        std::ranges::transform(values, std::back_inserter(plain), &Value::value);
        result.figure = printed("%.2f", median(plain));
        result.met = median(plain) <= goal;
    }
    return result;
}

/// Ratios of the project's error to the least of the other methods that `belongs` selects, in each scene, on each
/// machine and link.
template <class Belongs>
std::vector<Value> ratios(std::vector<ReportRun> const& runs, Belongs&& belongs) {
    std::map<std::tuple<std::string, double, double>, std::pair<double, double>> cells;
    for (ReportRun const& run : runs) {
        auto& [own, other] =
            cells.try_emplace({run.scene, run.machine, run.link}, std::pair<double, double>(INFINITY, INFINITY))
                .first->second;
        double const error = std::max(run.mse, least_mse);
        own = run.method == "framelet" ? error : own;
        other = belongs(run.method) ? std::min(other, error) : other;
    }
    std::vector<Value> result;
    for (auto const& [cell, errors] : cells) {
        if (std::isfinite(errors.first) && std::isfinite(errors.second)) {
            auto const& [scene, machine, link] = cell;
            std::string const conditions = link > 0 ? printed(", %g bits", link) : printed(", %g samples", machine);
            result.push_back({scene + conditions, errors.first / errors.second});
        }
    }
    return result;
}

/// Values of `get` for `framelet` in each of the real programs' scenes that has them.
template <class Get>
std::vector<Value> of_each(std::vector<json> const& live, Get&& get) {
    std::vector<Value> values;
    for (json const& scene : live) {
        double const value = get(scene, scene["methods"]["framelet"]);
        if (std::isfinite(value)) {
            values.push_back({scene["scene"], value});
        }
    }
    return values;
}

double number(json const& figures, char const* name, double scale = 1) {
    return figures.contains(name) && figures[name].is_number() ? scale * figures[name].get<double>() : NAN;
}

/// Ratios by which the project's figure is worse than the best rival's: a ratio of errors; where `sign` is -1, a ratio
/// of what lacks to 1.
std::vector<Value> beside_best_rival(std::vector<json> const& live, char const* figure, double sign) {
    return of_each(live, [&](json const& scene, json const& own) {
        double const rival = sign * best_rival(scene, figure, sign).first;
        double const mine = number(own, figure);
        return sign > 0 ? std::max(mine, least_mse) / std::max(rival, least_mse)
                        : std::max(1 - mine, least_mse) / std::max(1 - rival, least_mse);
    });
}

/// True if something moves in the scene, and not only jumps, as far as that is known.
bool moves(std::string const& title) {
    if (title.find(", flown") != std::string::npos) {
        return true;
    }
    try {
        return !events_of(title.substr(0, title.find(','))).motions.empty();
    } catch (InputError const&) { // the scene is not the generator's
        return true;
    }
}

std::vector<Value> steadiness(std::vector<json> const& live) {
    return of_each(live, [](json const& scene, json const& own) {
        json const warp = scene["methods"].value("framed+warp", json::object());
        return moves(scene["scene"]) ? number(own, "steadiness") / std::max(number(warp, "steadiness"), least_mse)
                                     : NAN;
    });
}

/// Cost of painting in the sessions with a core each, where the viewer has its own, at the greatest size.
std::vector<Value> painting(std::vector<json> const& clocks) {
    int greatest = 0;
    for (json const& run : clocks) {
        greatest = std::max(greatest, run["size"][0].get<int>());
    }
    std::vector<json> whole;
    std::ranges::copy_if(clocks, std::back_inserter(whole),
                         [&](json const& run) { return run["size"][0] == greatest; });
    return of_each(whole, [](json const&, json const& own) { return number(own, "paint_ns_per_pixel"); });
}

template <class Get>
std::vector<Value> of_walks(std::vector<json> const& walks, Get&& get) {
    std::vector<Value> values;
    for (json const& walk : walks) {
        values.push_back({walk["scene"], get(walk)});
    }
    return values;
}

std::vector<Value> response_shares(json const& features) {
    std::vector<Value> values;
    for (json const& row : features) {
        if (row.contains("response_share")) {
            values.push_back({row["what"], 100 * row["response_share"].get<double>()});
        }
    }
    return values;
}

std::vector<Value> bits(std::vector<ReportRun> const& linked) {
    std::vector<Value> values;
    for (std::string const& scene : distinct(linked, &ReportRun::scene)) {
        double const ratio = bits_at_equal_error(linked, scene, "framed+warp");
        if (!std::isnan(ratio)) {
            values.push_back({scene, ratio});
        }
    }
    return values;
}

/// Rate curve: logarithms of bits and of the least error that so many bits or fewer reach; bits ascend.
struct RateCurve {
    std::vector<double> bits, errors;

    RateCurve(std::vector<ReportRun> const& linked, std::string const& scene, std::string const& method) {
        auto runs = part(linked, [&](ReportRun const& r) { return r.scene == scene && r.method == method; });
        std::ranges::sort(runs, {}, &ReportRun::bits);
        for (ReportRun const& run : runs) {
            double const error = std::log(std::max(run.mse, least_mse));
            bits.push_back(std::log(std::max(run.bits, 1e-9)));
            errors.push_back(errors.empty() ? error : std::min(error, errors.back()));
        }
    }
    /// Logarithm of the bits for an error of this logarithm; beyond the curve's ends the value at the end.
    double bits_for(double error) const {
        auto const reached = std::ranges::find_if(errors, [&](double e) { return e <= error; });
        if (reached == errors.begin()) {
            return bits.front();
        }
        if (reached == errors.end()) { // the fewest bits that reach the least error
            return bits[static_cast<std::size_t>(std::ranges::find(errors, errors.back()) - errors.begin())];
        }
        auto const i = static_cast<std::size_t>(reached - errors.begin());
        return bits[i] + (error - errors[i]) / (errors[i - 1] - errors[i]) * (bits[i - 1] - bits[i]);
    }
};

} // namespace

double bits_at_equal_error(std::vector<ReportRun> const& linked, std::string const& scene, std::string const& rival) {
    RateCurve const own(linked, scene, "framelet"), other(linked, scene, rival);
    if (own.bits.empty() || other.bits.empty()) {
        return NAN;
    }
    double const least = std::max(own.errors.back(), other.errors.back());
    double const most = std::min(own.errors.front(), other.errors.front());
    if (own.errors.back() > other.errors.front()) {
        return INFINITY;
    }
    double const error = (least + most) / 2;
    return std::exp(own.bits_for(error) - other.bits_for(error));
}

std::vector<Goal> goals_of(ReportFigures const& figures) {
    std::vector<json> live = figures.live;
    live.insert(live.end(), figures.narrow.begin(), figures.narrow.end());
    auto const linked = part(figures.runs, [](ReportRun const& run) { return run.link > 0; });
    std::vector<Value> const mse = beside_best_rival(live, "mse", 1);
    std::vector<Value> const machines = ratios(unlimited(figures.runs), is_rival), links = ratios(linked, is_rival);
    Bound const most = Bound::at_most, least = Bound::at_least;
    std::vector<Goal> goals{
        all_of("real programs, narrow links included: MSE over the best rival's", mse, most, 1, 2),
        all_of("1 - SSIM over the best rival's", beside_best_rival(live, "ssim", -1), most, 1, 2),
        all_of("FLIP over the best rival's", beside_best_rival(live, "flip", 1), most, 1, 2),
        median_of("MSE over the best rival's, median", mse, 0.6),
        all_of("pictures a second",
               of_each(live, [](json const&, json const& own) { return number(own, "pictures_per_second"); }), least,
               30, 0),
        all_of("gap between pictures, 99th percentile, ms",
               of_each(live, [](json const&, json const& own) { return number(own, "gap_p99_ms"); }), most, 50, 0),
        all_of(
            "motion to photon, display frames",
            of_each(live, [](json const&, json const& own) { return number(own, "photon_ms", 1e-3 * display_rate); }),
            most, 2, 1),
        all_of("server busy, of what the viewer leaves of the machine",
               of_each(live,
                       [](json const&, json const& own) {
                           return number(own, "server_busy") / (1 - number(own, "viewer_busy"));
                       }),
               least, 0.9, 2),
        all_of("unsteadiness over `framed+warp`'s, where something moves", steadiness(live), most, 1, 2),
        all_of("virtual clock, no limit: MSE over the best rival's, scenes x machines", machines, most, 1, 2),
        median_of("the same, median", machines, 0.6),
        all_of("over links: MSE over the best rival's, scenes x links", links, most, 1, 2),
        median_of("the same, median", links, 0.6),
        all_of("while the camera turns: MSE over the best rival's, scenes x speeds", ratios(figures.turns, is_rival),
               most, 1, 2),
        all_of("a still scene, a camera that walks, 2 samples a pixel and second: PSNR",
               of_walks(figures.walks, [](json const& walk) { return walk["walking_psnr"].get<double>(); }), least, 32,
               1),
        all_of("the same, below that of the camera once it has stood for a second, dB",
               of_walks(figures.walks,
                        [](json const& walk) {
                            return walk["standing_psnr"].get<double>() - walk["walking_psnr"].get<double>();
                        }),
               most, 3, 1),
        all_of("a still scene, a camera that jumps: % of jumps after which the error never rises by 2%",
               of_walks(figures.walks,
                        [](json const& walk) {
                            return 100 * walk["steady_jumps"].get<double>() / walk["jumps"].get<double>();
                        }),
               least, 100, 0),
        all_of("painting a changed pixel, ns of a core", painting(figures.clocks), most, 15, 1),
        all_of("response, mirror included, % of the server's time", response_shares(figures.features), most, 5, 1),
        all_of("bits over `framed+warp`'s at equal error", bits(linked), most, 1, 2),
    };
    return goals;
}

std::string goals_table(std::vector<Goal> const& goals) {
    std::string text = "| what | goal | figure | met |\n|---|---|---|---|\n";
    for (Goal const& goal : goals) {
        text += "| " + goal.what + " | " + goal.goal + " | " + goal.figure + " | " + (goal.met ? "yes" : "no") + " |\n";
    }
    return text;
}

} // namespace framelet::bench
