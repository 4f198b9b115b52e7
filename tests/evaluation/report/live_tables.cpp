#include "tests/evaluation/report/live_tables.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/evaluation/report/report_text.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// A sentence that says in how many scenes the project is not worse than the best rival, by each measure.
std::string live_summary(std::vector<json> const& live) {
    auto const wins = [&](char const* figure, double sign) {
        return std::ranges::count_if(live, [&](json const& scene) {
            double const own = scene["methods"]["framelet"][figure];
            return sign * own <= best_rival(scene, figure, sign).first;
        });
    };
    std::vector<double> ratios;
    for (json const& scene : live) {
        ratios.push_back(scene["methods"]["framelet"]["mse"].get<double>() / best_rival(scene, "mse", 1).first);
    }
    return printed(
        "\n`framelet` is at least as good as the best rival in %zd of %zu by MSE (median ratio %.2f), in %zd by "
        "SSIM, %zd by FLIP, %zd in steadiness.\n",
        wins("mse", 1), live.size(), median(ratios), wins("ssim", -1), wins("flip", 1), wins("steadiness", 1));
}

/// A table cell of one figure of several runs, "-" where it is no number; the best of them in bold: the least, or, for
/// `sign` -1, the most. `sign` 0: none is.
std::string side_by_side(std::vector<json> const& runs, char const* figure, char const* format, double scale,
                         int sign) {
    auto const value = [&](json const& run) {
        return run.contains(figure) && run[figure].is_number() ? scale * run[figure].get<double>() : NAN;
    };
    double best = INFINITY;
    for (json const& run : runs) {
        best = std::min(best, sign * value(run)); // a NaN is not less
    }
    std::string text;
    for (json const& run : runs) {
        bool const is_best = sign != 0 && sign * value(run) == best;
        std::string const number = std::isnan(value(run)) ? "-" : printed(format, value(run));
        text += (text.empty() ? "" : " / ") + bold_if(is_best, number);
    }
    return text + " | ";
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

std::string live_table(std::vector<json> const& live) {
    std::string text = "| scene | best rival | PSNR | SSIM | FLIP | unsteady, 1e-3 | pictures/s | gap p99, ms | "
                       "server busy | kB/s |\n|---|---|---|---|---|---|---|---|---|---|\n";
    for (json const& scene : live) {
        std::string const rival = best_rival(scene, "mse", 1).second;
        std::vector<json> runs;
        for (std::string const& method : {std::string("framelet"), std::string("framelet-unwarped"), rival}) {
            runs.push_back(scene["methods"].value(method, json::object()));
        }
        json const& best = runs.back();
        text += "| `" + scene["scene"].get<std::string>() + "` | `" + rival + "`";
        text += best.contains("spacing")
                    ? printed(best["margin"] > 0 ? " (%d, margin) | " : " (%d) | ", best["spacing"].get<int>())
                    : " | ";
        text += side_by_side(runs, "psnr", "%.2f", 1, -1) + side_by_side(runs, "ssim", "%.3f", 1, -1) +
                side_by_side(runs, "flip", "%.3f", 1, 1) + side_by_side(runs, "steadiness", "%.2f", 1e3, 1) +
                side_by_side(runs, "pictures_per_second", "%.0f", 1, 0) +
                side_by_side(runs, "gap_p99_ms", "%.0f", 1, 0) + side_by_side(runs, "server_busy", "%.2f", 1, 0) +
                side_by_side(runs, "kB_per_second", "%.0f", 1, 0);
        text.back() = '\n';
    }
    return text + live_summary(live);
}

std::string clock_table(std::vector<json> const& clocks) {
    std::vector<std::string> scenes;
    std::map<std::string, std::string> rows;
    std::string sizes, line;
    std::vector<double> errors, bytes, pictures, shares;
    for (json const& run : clocks) {
        std::string const scene = run["scene"];
        json const& wall = run["methods"]["framelet"];
        json const& said = wall["virtual"];
        auto const ratio = [&](char const* what) {
            return said[what].get<double>() / std::max(wall["steady"][what].get<double>(), 1e-9);
        };
        if (rows[scene].empty()) {
            scenes.push_back(scene);
            rows[scene] = "| `" + scene + "` |";
        }
        std::string const size = printed("%dx%d", run["size"][0].get<int>(), run["size"][1].get<int>());
        if (sizes.find(size) == std::string::npos) {
            sizes += " " + size + ": dB | virtual | kB/s | pictures | busy | unwarped |";
            line += "---|---|---|---|---|---|";
        }
        double const difference = said["psnr"].get<double>() - wall["psnr"].get<double>();
        errors.push_back(std::abs(difference));
        bytes.push_back(std::abs(ratio("kB_per_second") - 1));
        pictures.push_back(std::abs(ratio("pictures_per_second") - 1));
        rows[scene] += printed(" %.2f | ", wall["psnr"].get<double>()) +
                       bold_if(errors.back() > 0.5, printed("%+.2f", difference)) + " |";
        for (char const* const what : {"kB_per_second", "pictures_per_second"}) {
            rows[scene] += " " + bold_if(std::abs(ratio(what) - 1) > 0.1, printed("%.2f", ratio(what))) + " |";
        }
        double const busy = wall["server_cores"], unwarped = run["methods"]["framelet-unwarped"]["server_cores"];
        shares.push_back(std::abs(busy / std::max(unwarped, 1e-9) - 1));
        rows[scene] += printed(" %.2f | ", busy) + bold_if(shares.back() > 0.05, printed("%.2f", unwarped)) + " |";
    }
    std::string text = "| scene |" + sizes + "\n|---|" + line + "\n";
    for (std::string const& scene : scenes) {
        text += rows[scene] + "\n";
    }
    auto const within = [](std::vector<double> const& values, double bound) {
        return std::ranges::count_if(values, [bound](double value) { return value <= bound; });
    };
    return text +
           printed("\nWithin 0.5 dB: %zd of %zu; within 10%%: bytes %zd, pictures %zd; equally busy within 5%%: %zd.\n",
                   within(errors, 0.5), errors.size(), within(bytes, 0.1), within(pictures, 0.1), within(shares, 0.05));
}

} // namespace framelet::bench
