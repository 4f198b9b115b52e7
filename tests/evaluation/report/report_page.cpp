#include "tests/evaluation/report/report_page.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <fstream>
#include <functional>
#include <thread>

#include "common/error.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/scene_events.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// Shaded samples a second of one core where every sample has a shadow ray and a quarter mirror; the bundled scenes
/// reach a third to a half of it.
constexpr double core_rate = 5.3e6;
constexpr double screen_pixels = 1920.0 * 1080;
/// Errors below this are those of rounding to bytes.
constexpr double least_mse = 1e-9;
constexpr char const* phases[] = {"moving", "event", "settled"};

[[gnu::format(printf, 1, 2)]] std::string printed(char const* format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof(text), format, arguments);
    va_end(arguments);
    return text;
}

bool is_own(std::string const& method) {
    return method.starts_with("framelet");
}

/// Neither the project's nor a yardstick that knows the truth.
bool is_rival(std::string const& method) {
    return !is_own(method) && method != "oracle";
}

/// Names in the order in which they come first.
template <class Get>
auto distinct(std::vector<ReportRun> const& runs, Get&& get) {
    std::vector<std::decay_t<decltype(get(runs.front()))>> found;
    for (ReportRun const& run : runs) {
        if (std::ranges::find(found, get(run)) == found.end()) {
            found.push_back(get(run));
        }
    }
    return found;
}

std::vector<ReportRun> part(std::vector<ReportRun> const& runs, std::function<bool(ReportRun const&)> const& belongs) {
    std::vector<ReportRun> result;
    std::ranges::copy_if(runs, std::back_inserter(result), belongs);
    return result;
}

using Value = std::function<double(ReportRun const&)>;

double relative_error(ReportRun const& run) {
    return run.mse / std::max(run.noise, least_mse);
}

Spread spread_over(std::vector<ReportRun> const& runs, Value const& value) {
    std::vector<double> values;
    std::ranges::transform(runs, std::back_inserter(values), value);
    return spread_of(std::move(values));
}

std::vector<Mark> core_marks() {
    std::vector<Mark> marks;
    for (int const cores : {2, 8, 32}) {
        marks.push_back({cores * core_rate / screen_pixels, "1080p, " + std::to_string(cores) + " cores"});
    }
    return marks;
}

/// Of each method over all scenes: a point for each value of `step`.
std::vector<Curve> curves_of(std::vector<ReportRun> const& runs, Value const& step, Value const& x, Value const& y) {
    std::vector<Curve> curves;
    for (std::string const& method : distinct(runs, [](ReportRun const& run) { return run.method; })) {
        Curve curve{method, {}, {}};
        for (double const value : distinct(runs, step)) {
            auto const there =
                part(runs, [&](ReportRun const& run) { return run.method == method && step(run) == value; });
            Spread const spread = spread_over(there, y);
            curve.x.push_back(spread_over(there, x).mean);
            curve.y.push_back(spread.mean);
            curve.low.push_back(spread.low);
            curve.high.push_back(spread.high);
        }
        curves.push_back(std::move(curve));
    }
    return curves;
}

/// At each machine, without a link's limit.
Curves machine_chart(ReportFigures const& figures, std::string const& what, Value const& value) {
    Value const machine = [](ReportRun const& run) { return run.machine; };
    return {.title = what + ": geometric mean over scenes, quartiles shaded",
            .x_title = "machine [samples a displayed pixel and second]",
            .y_title = what,
            .log_x = true,
            .log_y = true,
            .curves = curves_of(part(figures.runs, [](ReportRun const& run) { return run.link == 0; }), machine,
                                machine, value),
            .marks = core_marks()};
}

ReportRun const* find_run(std::vector<ReportRun> const& runs, std::string const& scene, std::string const& method) {
    auto const found =
        std::ranges::find_if(runs, [&](ReportRun const& r) { return r.scene == scene && r.method == method; });
    return found == runs.end() ? nullptr : &*found;
}

/// The project's error over that of the best rival, of a phase; and who that is.
struct Ratio {
    double value = NAN;
    std::string rival;
};

Ratio ratio_of(std::vector<ReportRun> const& runs, std::string const& scene, std::string const& own,
               std::string const& phase) {
    ReportRun const* const mine = find_run(runs, scene, own);
    Ratio result;
    double least = INFINITY;
    for (ReportRun const& run : runs) {
        if (run.scene == scene && is_rival(run.method) && run.phases.contains(phase) && run.phases.at(phase) < least) {
            least = run.phases.at(phase);
            result.rival = run.method;
        }
    }
    if (mine != nullptr && mine->phases.contains(phase) && std::isfinite(least)) {
        result.value = std::max(mine->phases.at(phase), least_mse) / std::max(least, least_mse);
    }
    return result;
}

std::string cell(Ratio const& ratio) {
    if (std::isnan(ratio.value)) {
        return "-";
    }
    return printed(ratio.value > 1 ? "**%.2f** %s" : "%.2f %s", ratio.value, ratio.rival.c_str());
}

std::string ratio_table(std::vector<ReportRun> const& runs) {
    std::string text = "| scene | moving | event | settled | without reprojection: moving | event | settled |\n"
                       "|---|---|---|---|---|---|---|\n";
    std::size_t lost = 0, all = 0;
    std::vector<double> moving;
    for (std::string const& scene : distinct(runs, [](ReportRun const& run) { return run.scene; })) {
        text += "| `" + scene + "` |";
        for (char const* const own : {"framelet", "framelet-unwarped"}) {
            for (char const* const phase : phases) {
                Ratio const ratio = ratio_of(runs, scene, own, phase);
                text += printed(" %s |", cell(ratio).c_str());
                bool const counts = own == std::string("framelet") && !std::isnan(ratio.value);
                all += counts ? 1 : 0;
                lost += counts && ratio.value > 1 ? 1 : 0;
                if (counts && phase == std::string("moving")) {
                    moving.push_back(ratio.value);
                }
            }
        }
        text += "\n";
    }
    text += printed("\nLost: %zu of %zu.", lost, all);
    if (!moving.empty()) {
        std::ranges::sort(moving);
        text += printed(" Median while something moves: %.2f.", moving[moving.size() / 2]);
    }
    return text + "\n";
}

double best_rival(json const& scene, char const* measure, bool most) {
    double best = most ? -INFINITY : INFINITY;
    for (auto const& [method, figures] : scene["methods"].items()) {
        if (is_rival(method)) {
            best =
                most ? std::max(best, figures[measure].get<double>()) : std::min(best, figures[measure].get<double>());
        }
    }
    return best;
}

/// In how many scenes the project is not worse than the best rival, by each measure.
std::string live_summary(std::vector<json> const& live) {
    std::vector<double> ratios;
    std::size_t ssim = 0, flip = 0, steady = 0;
    for (json const& scene : live) {
        json const& own = scene["methods"]["framelet"];
        ratios.push_back(own["mse"].get<double>() / best_rival(scene, "mse", false));
        ssim += own["ssim"] >= best_rival(scene, "ssim", true) ? 1 : 0;
        flip += own["flip"] <= best_rival(scene, "flip", false) ? 1 : 0;
        steady += own["steadiness"] <= best_rival(scene, "steadiness", false) ? 1 : 0;
    }
    std::ranges::sort(ratios);
    auto const mse = std::ranges::count_if(ratios, [](double ratio) { return ratio <= 1; });
    return printed(
        "\n`framelet` is at least as good as the best rival in %zd of %zu by MSE (median ratio %.2f), in %zu by "
        "SSIM, %zu by FLIP, %zu in steadiness.\n",
        mse, live.size(), ratios[ratios.size() / 2], ssim, flip, steady);
}

/// What virtual and wall clock say of the same sessions, a row a scene.
std::string clock_table(std::vector<json> const& clocks) {
    std::vector<std::string> scenes;
    std::map<std::string, std::string> rows;
    std::string sizes, line;
    std::vector<double> errors, bytes, pictures;
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
            sizes += " " + size + ": dB | virtual | kB/s | pictures |";
            line += "---|---|---|---|";
        }
        double const difference = said["psnr"].get<double>() - wall["psnr"].get<double>();
        errors.push_back(std::abs(difference));
        bytes.push_back(std::abs(ratio("kB_per_second") - 1));
        pictures.push_back(std::abs(ratio("pictures_per_second") - 1));
        rows[scene] += printed(std::abs(difference) > 0.5 ? " %.2f | **%+.2f** |" : " %.2f | %+.2f |",
                               wall["psnr"].get<double>(), difference);
        for (char const* const what : {"kB_per_second", "pictures_per_second"}) {
            rows[scene] += printed(std::abs(ratio(what) - 1) > 0.1 ? " **%.2f** |" : " %.2f |", ratio(what));
        }
    }
    std::string text = "| scene |" + sizes + "\n|---|" + line + "\n";
    for (std::string const& scene : scenes) {
        text += rows[scene] + "\n";
    }
    auto const within = [](std::vector<double> const& values, double bound) {
        return std::ranges::count_if(values, [bound](double value) { return value <= bound; });
    };
    return text + printed("\nWithin 0.5 dB: %zd of %zu; within 10%%: bytes %zd, pictures %zd.\n", within(errors, 0.5),
                          errors.size(), within(bytes, 0.1), within(pictures, 0.1));
}

/// The rival that errs least in a scene, as `methods` names it; empty where none ran.
std::string best_rival_of(json const& scene) {
    std::string best;
    for (auto const& [method, figures] : scene["methods"].items()) {
        if (is_rival(method) && (best.empty() || figures["mse"] < scene["methods"][best]["mse"])) {
            best = method;
        }
    }
    return best;
}

/// One figure of several runs, "-" where it is none; the best of them in bold: the least, or, for `sign` -1, the most.
/// `sign` 0: none is.
std::string side_by_side(std::vector<json> const& runs, char const* figure, char const* format, double scale,
                         int sign) {
    auto const value = [&](json const& run) {
        return run.contains(figure) && run[figure].is_number() ? scale * run[figure].get<double>() : NAN;
    };
    double best = INFINITY;
    for (json const& run : runs) {
        best = std::min(best, sign * value(run)); // what is no number is not less
    }
    std::string text;
    for (json const& run : runs) {
        bool const is_best = sign != 0 && sign * value(run) == best;
        std::string const number = std::isnan(value(run)) ? "-" : printed(format, value(run));
        text += (text.empty() ? "" : " / ") + (is_best ? "**" + number + "**" : number);
    }
    return text + " | ";
}

std::string live_table(std::vector<json> const& live) {
    std::string text = "| scene | best rival | PSNR | SSIM | FLIP | unsteady, 1e-3 | pictures/s | gap p99, ms | "
                       "server busy | kB/s |\n|---|---|---|---|---|---|---|---|---|---|\n";
    for (json const& scene : live) {
        std::string const rival = best_rival_of(scene);
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

std::string feature_table(json const& rows) {
    std::string text = "| `stop` | render, ns | all else, ns | rays | bytes |\n|---|---|---|---|---|\n";
    for (json const& row : rows) {
        text += printed("| %s | %.0f | %.0f | %.2f | %.2f |\n", row["what"].get<std::string>().c_str(),
                        row["render_ns"].get<double>(), row["other_ns"].get<double>(), row["rays"].get<double>(),
                        row["bytes"].get<double>());
    }
    return text;
}

/// A row a method, a column a machine.
std::string speed_table(ReportFigures const& figures) {
    auto const free = part(figures.runs, [](ReportRun const& run) { return run.link == 0; });
    auto const machines = distinct(free, [](ReportRun const& run) { return run.machine; });
    std::string text = "| samples a pixel and second |", line = "|---|";
    for (double const machine : machines) {
        text += printed(" %g |", machine);
        line += "---|";
    }
    text += "\n" + line + "\n";
    for (Curve const& curve : speed_chart(figures).curves) {
        text += "| `" + curve.name + "` |";
        for (double const y : curve.y) {
            text += printed(" %.1f |", y);
        }
        text += "\n";
    }
    return text;
}

std::string processor_name() {
    std::ifstream stream("/proc/cpuinfo");
    for (std::string line; std::getline(stream, line);) {
        if (line.starts_with("model name")) {
            return line.substr(line.find(':') + 2);
        }
    }
    return "an unknown processor";
}

std::string names_of(std::set<std::string> const& commits) {
    std::string text;
    for (std::string const& commit : commits) {
        text += (text.empty() ? "" : ", ") + commit;
    }
    return text;
}

double nearest(std::vector<double> const& values, double wanted) {
    return *std::ranges::min_element(values, {}, [&](double value) { return std::abs(std::log(value / wanted)); });
}

template <class Chart>
void draw_png(Chart const& chart, std::filesystem::path const& stem) {
    draw(chart, stem);
    std::filesystem::remove(stem.string() + ".svg"); // the page shows the other one
}

} // namespace

Spread spread_of(std::vector<double> values) {
    FRAMELET_CHECK(!values.empty());
    std::ranges::sort(values);
    double sum = 0;
    for (double& value : values) {
        value = std::log(std::max(value, least_mse));
        sum += value;
    }
    auto const at = [&](double share) {
        double const place = share * static_cast<double>(values.size() - 1);
        auto const below = static_cast<std::size_t>(place);
        double const above = values[std::min(below + 1, values.size() - 1)];
        return std::exp(values[below] + (place - static_cast<double>(below)) * (above - values[below]));
    };
    return {at(0.25), std::exp(sum / static_cast<double>(values.size())), at(0.75)};
}

Curves speed_chart(ReportFigures const& figures) {
    return machine_chart(figures, "error over the reference's own noise", relative_error);
}

Curves flip_chart(ReportFigures const& figures) {
    return machine_chart(figures, "FLIP", [](ReportRun const& run) { return run.flip; });
}

Curves steadiness_chart(ReportFigures const& figures) {
    return machine_chart(figures, "unsteadiness (second difference of the error)",
                         [](ReportRun const& run) { return run.unsteadiness; });
}

Curves bits_chart(ReportFigures const& figures) {
    return {.title = "error over the reference's own noise: geometric mean over scenes, quartiles shaded",
            .x_title = "sent [bits a displayed pixel and second]",
            .y_title = "error over the reference's own noise",
            .log_x = true,
            .log_y = true,
            .curves = curves_of(
                part(figures.runs, [](ReportRun const& run) { return run.link > 0; }),
                [](ReportRun const& run) { return run.link; }, [](ReportRun const& run) { return run.bits; },
                relative_error)};
}

Curves live_chart(std::vector<json> const& live) {
    Curves chart{.title = "the real programs: a point a scene",
                 .x_title = "pictures a second",
                 .y_title = "mean squared error over the best method's",
                 .log_y = true,
                 .drawn = Drawn::points,
                 .curves = {}};
    for (json const& scene : live) {
        double least = INFINITY;
        for (json const& figures : scene["methods"]) {
            least = std::min(least, figures["mse"].get<double>());
        }
        for (auto const& [method, figures] : scene["methods"].items()) {
            auto curve = std::ranges::find(chart.curves, method, &Curve::name);
            if (curve == chart.curves.end()) {
                chart.curves.push_back({method, {}, {}});
                curve = std::prev(chart.curves.end());
            }
            curve->x.push_back(figures["pictures_per_second"]);
            curve->y.push_back(figures["mse"].get<double>() / std::max(least, least_mse));
        }
    }
    return chart;
}

std::string report_page(ReportFigures const& figures, ReportOptions const& options, StudyOptions const& study,
                        std::string const& command) {
    RunParameters const& run = study.run;
    double const machine = nearest(options.machines, 2 * core_rate / screen_pixels);
    auto const at = [&](double wanted_machine, double link) {
        return part(figures.runs, [=](ReportRun const& r) { return r.machine == wanted_machine && r.link == link; });
    };
    std::string page = "# Results\n\n    " + command + "\n\n";
    page += "Commit " + names_of(figures.commits) +
            printed(", %u cores of %s.", std::thread::hardware_concurrency(), processor_name().c_str());
    page +=
        printed(" Virtual clock: %zu scenes at %dx%d, %g s that see each scene's events, %g measurements a second.\n",
                study.scenes.size(), run.viewport.width, run.viewport.height, run.seconds, run.reference_rate);
    page +=
        "Methods, machine, link and measures are explained in [tests/evaluation](../tests/evaluation/README.md); each "
        "rival has the spacing and margin\nwith which it errs least. ";
    page += options.quick ? "This is the quick run: it shows that the report works, and nothing else.\n" : "\n";

    page += "\n## Speed against accuracy\n\n![error against speed](pictures/speed.png)\n\n" + speed_table(figures);
    page +=
        printed("\nMean squared error over that of the reference itself (%d samples a pixel), geometric mean over "
                "scenes. A core is taken to shade %.1f million samples a\nsecond, as it does with a shadow ray each "
                "and mirrors here and there; the link has no limit.\n",
                study.samples_per_side * study.samples_per_side, core_rate / 1e6);
    page += "\n![FLIP](pictures/flip.png)\n![unsteadiness](pictures/steadiness.png)\n";
    if (!options.links.empty()) {
        page += printed("\nOver links of several rates, %g ms each way, a machine of %g samples a pixel and second:\n",
                        1e3 * options.link_delay, options.link_machine);
        page += "\n![error against bits](pictures/bits.png)\n";
    }

    page +=
        printed("\n## Against the best rival, scene by scene\n\nMSE of `framelet` over that of whichever rival errs "
                "least in that phase; above 1, in bold, is a loss. An event lasts %g s.\n\n### %g samples a pixel "
                "and second (1080p on two cores), no limit of the link\n\n",
                event_seconds, machine);
    page += ratio_table(at(machine, 0));
    if (!options.links.empty()) {
        double const link = options.links[options.links.size() / 2];
        page += printed("\n### %g samples a pixel and second, %g bits a pixel and second, %g ms each way\n\n",
                        options.link_machine, link, 1e3 * options.link_delay);
        page += ratio_table(at(options.link_machine, link));
    }
    if (!figures.live.empty()) {
        page += printed(
            "\n## The real programs\n\n`framelet-bench live` at %dx%d for %g s: server and viewer on the same "
            "cores, a real socket, the clock running; compared at %d moments. Figures are of `framelet` / the same "
            "without reprojection / the rival that errs least (in brackets the spacing of its frames), the best in "
            "bold.\n\n![error against pictures a second](pictures/live.png)\n\n",
            options.live.viewport.width, options.live.viewport.height, options.live.seconds, options.live.moments);
        page += live_table(figures.live);
    }
    if (!figures.clocks.empty()) {
        page +=
            "\n### The same sessions on the virtual clock\n\n`framelet` with a core for the server and one for the "
            "viewer: PSNR by "
            "the wall clock, how much more the virtual clock says, its bytes and pictures over the wall clock's. Far "
            "ones in bold.\n\n";
        page += clock_table(figures.clocks);
    }
    page +=
        printed("\n## What each kind of scene costs\n\nA sample of a session at %dx%d, one thread: the scene `stop`, "
                "with one thing more in each row. While nothing moves the picture is refined, at last with four rays a "
                "sample, and what it has is not sent again.\n\n",
                options.feature_viewport.width, options.feature_viewport.height);
    return page + feature_table(figures.features);
}

void write_report(ReportFigures const& figures, ReportOptions const& options, StudyOptions const& study,
                  std::string const& command) {
    auto const pictures = options.documents / "pictures";
    std::filesystem::create_directories(pictures);
    draw_png(speed_chart(figures), pictures / "speed");
    draw_png(flip_chart(figures), pictures / "flip");
    draw_png(steadiness_chart(figures), pictures / "steadiness");
    if (!options.links.empty()) {
        draw_png(bits_chart(figures), pictures / "bits");
    }
    if (!figures.live.empty()) {
        draw_png(live_chart(figures.live), pictures / "live");
    }
    auto const file = options.documents / "RESULTS.md";
    std::ofstream stream(file);
    stream << report_page(figures, options, study, command);
    if (!stream.flush()) {
        throw InputError("cannot write '" + file.string() + "'");
    }
    std::printf("%s\n", file.c_str());
}

} // namespace framelet::bench
