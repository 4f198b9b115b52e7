#include "tests/evaluation/report/report_tables.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "tests/evaluation/report/report_text.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr double display_rate = 60;

/// A figure of one scene or run.
struct Value {
    std::string of;
    double value = 0;
};

enum class Bound { at_most, at_least };

/// A row of the table of goals: how many values keep the bound, their median, and which one is farthest from it.
std::string goal_row(std::string const& what, std::vector<Value> const& values, Bound bound, double goal,
                     int decimals) {
    bool const most = bound == Bound::at_most;
    std::string const start = "| " + what + " | " + (most ? "<= " : ">= ") + printed("%g", goal) + " in each | ";
    if (values.empty()) {
        return start + "not measured | no |\n";
    }
    auto const kept =
        std::ranges::count_if(values, [&](Value const& v) { return most ? v.value <= goal : v.value >= goal; });
    Value const& worst = most ? *std::ranges::max_element(values, {}, &Value::value)
                              : *std::ranges::min_element(values, {}, &Value::value);
    std::vector<double> plain;
    std::ranges::transform(values, std::back_inserter(plain), &Value::value);
    return start + printed("%zd of %zu; median %.*f, worst %.*f (`%s`) | %s |\n", kept, values.size(), decimals,
                           median(plain), decimals, worst.value, worst.of.c_str(),
                           kept == std::ssize(values) ? "yes" : "no");
}

double number(json const& figures, char const* name) {
    return figures.contains(name) && figures[name].is_number() ? figures[name].get<double>() : NAN;
}

/// A figure of `framelet` in each scene that has it.
std::vector<Value> own_figures(std::vector<json> const& live, char const* name, double scale = 1) {
    std::vector<Value> values;
    for (json const& scene : live) {
        double const value = scale * number(scene["methods"]["framelet"], name);
        if (std::isfinite(value)) {
            values.push_back({scene["scene"], value});
        }
    }
    return values;
}

/// Ratio by which `framelet` is worse than the best rival: of errors or, where `sign` is -1, of what lacks to 1.
double ratio_to_rival(json const& scene, char const* figure, double sign) {
    double const rival = sign * best_rival(scene, figure, sign).first;
    double const own = number(scene["methods"]["framelet"], figure);
    return sign > 0 ? std::max(own, least_mse) / std::max(rival, least_mse)
                    : std::max(1 - own, least_mse) / std::max(1 - rival, least_mse);
}

std::vector<Value> beside_best_rival(std::vector<json> const& live, char const* figure, double sign) {
    std::vector<Value> values;
    for (json const& scene : live) {
        values.push_back({scene["scene"], ratio_to_rival(scene, figure, sign)});
    }
    return values;
}

std::vector<Value> beside_best_rival(std::vector<LinkRun> const& links) {
    std::vector<Value> values;
    for (LinkRun const& run : links) {
        values.push_back({run.figures["scene"].get<std::string>() +
                              printed(", %g Mbit/s, %g ms", run.link.megabits, run.link.round_trip),
                          ratio_to_rival(run.figures, "mse", 1)});
    }
    return values;
}

/// The error of `framelet` over that of the rival that errs least, and that rival; NaN where one is missing.
std::pair<double, std::string> beside_best_rival(std::vector<CoreRun> const& runs, std::string const& scene,
                                                 int cores) {
    double own = NAN, least = INFINITY;
    std::string rival;
    for (CoreRun const& run : runs) {
        if (run.scene != scene || run.cores != cores) {
            continue;
        }
        double const error = std::max(run.mse, least_mse);
        if (run.method == "framelet") {
            own = error;
        } else if (is_rival(run.method) && error < least) {
            least = error;
            rival = run.method;
        }
    }
    return {std::isfinite(least) ? own / least : NAN, rival};
}

template <class Run, class Member>
auto values_of(std::vector<Run> const& runs, Member Run::*member) {
    std::set<Member> values;
    std::ranges::transform(runs, std::inserter(values, values.end()), member);
    return values;
}

std::vector<Value> beside_best_rival(std::vector<CoreRun> const& runs) {
    std::vector<Value> values;
    for (std::string const& scene : values_of(runs, &CoreRun::scene)) {
        for (int const cores : values_of(runs, &CoreRun::cores)) {
            if (double const ratio = beside_best_rival(runs, scene, cores).first; !std::isnan(ratio)) {
                values.push_back({scene + printed(", %d cores", cores), ratio});
            }
        }
    }
    return values;
}

/// "own / rival" of one figure, in bold where it is lost. `sign`: 1 where less is better, -1 where more is, 0 for none.
std::string side_by_side(json const& own, json const& rival, char const* figure, char const* format, double scale,
                         int sign) {
    auto const text = [&](json const& run) {
        double const value = scale * number(run, figure);
        std::string digits(32, '\0');
        digits.resize(static_cast<std::size_t>(std::snprintf(digits.data(), digits.size(), format, value)));
        return std::isnan(value) ? std::string("-") : digits;
    };
    bool const is_lost = sign != 0 && sign * number(own, figure) > sign * number(rival, figure);
    return bold_if(is_lost, text(own) + " / " + text(rival)) + " | ";
}

std::string rules(std::size_t columns) {
    std::string line = "|";
    for (std::size_t i = 0; i < columns; ++i) {
        line += "---|";
    }
    return line + "\n";
}

} // namespace

std::pair<double, std::string> best_rival(json const& scene, char const* figure, double sign) {
    std::pair<double, std::string> best{INFINITY, ""};
    for (auto const& [method, figures] : scene["methods"].items()) {
        if (is_rival(method)) {
            best = std::min(best, {sign * figures[figure].get<double>(), method});
        }
    }
    return best;
}

double mean_error(std::vector<CoreRun> const& runs, std::string const& method, int cores) {
    double sum = 0;
    int count = 0;
    for (CoreRun const& run : runs) {
        if (run.method == method && run.cores == cores) {
            sum += std::log(std::max(run.mse, least_mse));
            ++count;
        }
    }
    return count > 0 ? std::exp(sum / count) : 0;
}

std::string goals_table(ReportFigures const& figures) {
    Bound const most = Bound::at_most, least = Bound::at_least;
    std::string text = "| what | goal | figure | met |\n" + rules(4);
    text += goal_row("real programs: MSE over the best rival's", beside_best_rival(figures.live, "mse", 1), most, 1, 2);
    text += goal_row("1 - SSIM over the best rival's", beside_best_rival(figures.live, "ssim", -1), most, 1, 2);
    text += goal_row("FLIP over the best rival's", beside_best_rival(figures.live, "flip", 1), most, 1, 2);
    text += goal_row("pictures a second", own_figures(figures.live, "pictures_per_second"), least, 30, 0);
    text += goal_row("gap between pictures, 99th percentile, ms", own_figures(figures.live, "gap_p99_ms"), most, 50, 0);
    text += goal_row("motion to photon, display frames", own_figures(figures.live, "photon_ms", 1e-3 * display_rate),
                     most, 2, 1);
    text += goal_row("full light: MSE over the best rival's", beside_best_rival(figures.lit, "mse", 1), most, 1, 2);
    text += goal_row("over links: MSE over the best rival's", beside_best_rival(figures.links), most, 1, 2);
    text += goal_row("virtual clock: MSE over the best rival's", beside_best_rival(figures.cores), most, 1, 2);
    return text;
}

std::string live_table(std::vector<json> const& live) {
    std::string text =
        "| scene | best rival | PSNR, dB | spread | SSIM | FLIP | pictures/s | gap, ms | MB/s |\n" + rules(9);
    for (json const& scene : live) {
        std::string const rival = best_rival(scene, "mse", 1).second;
        json const& own = scene["methods"]["framelet"];
        json const best = scene["methods"].value(rival, json::object());
        text += "| `" + scene["scene"].get<std::string>() + "` | `" + rival + "`";
        text += best.contains("spacing")
                    ? printed(best["margin"] > 0 ? " (%d, margin) | " : " (%d) | ", best["spacing"].get<int>())
                    : " | ";
        text += side_by_side(own, best, "psnr", "%.1f", 1, -1);
        text += printed("%.1f-%.1f / %.1f-%.1f | ", number(own, "psnr_low"), number(own, "psnr_high"),
                        number(best, "psnr_low"), number(best, "psnr_high"));
        text += side_by_side(own, best, "ssim", "%.3f", 1, -1) + side_by_side(own, best, "flip", "%.3f", 1, 1) +
                side_by_side(own, best, "pictures_per_second", "%.0f", 1, -1) +
                side_by_side(own, best, "gap_p99_ms", "%.0f", 1, 1) +
                side_by_side(own, best, "kB_per_second", "%.1f", 1e-3, 0);
        text.back() = '\n';
    }
    return text;
}

std::string links_table(std::vector<LinkRun> const& links) {
    std::string text = "| scene | Mbit/s | round trip, ms | `framelet` | `framed+warp` | `framed+h264` |\n" + rules(6);
    for (LinkRun const& run : links) {
        json const& methods = run.figures["methods"];
        text +=
            "| `" + run.figures["scene"].get<std::string>() +
            printed("` | %g | %g | ", run.link.megabits, run.link.round_trip) +
            bold_if(ratio_to_rival(run.figures, "mse", 1) > 1, printed("%.1f", number(methods["framelet"], "psnr")));
        for (char const* const rival : {"framed+warp", "framed+h264"}) {
            text += printed(" | %.1f", number(methods.value(rival, json::object()), "psnr"));
        }
        text += " |\n";
    }
    return text;
}

std::string cores_table(std::vector<CoreRun> const& runs) {
    std::set<int> const cores = values_of(runs, &CoreRun::cores);
    std::string text = "| scene |";
    for (int const count : cores) {
        text += printed(" %d cores |", count);
    }
    text += "\n" + rules(1 + cores.size());
    for (std::string const& scene : values_of(runs, &CoreRun::scene)) {
        text += "| `" + scene + "` |";
        for (int const count : cores) {
            auto const [ratio, rival] = beside_best_rival(runs, scene, count);
            text += " " + (std::isnan(ratio) ? "-" : bold_if(ratio > 1, printed("%.2f", ratio)) + " " + rival) + " |";
        }
        text += "\n";
    }
    return text;
}

} // namespace framelet::bench
