#include "tests/evaluation/soak/soak.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/evaluation/figure_table.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/soak/memory_judgement.h"
#include "tests/evaluation/soak/process_watch.h"
#include "tests/evaluation/soak/soak_viewer.h"
#include "tests/evaluation/soak/strangers.h"
#include "tests/evaluation/soak/web_relay.h"
#include "tests/loopback/process.h"

namespace framelet::bench {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr auto step = std::chrono::milliseconds(50); ///< time between pictures of a viewer
constexpr double patience = 120; ///< seconds to wait for what is to come by itself
/// Scene times at which the scene stands in the calms, seconds. They are between the keys of what moves.
constexpr double still_times[] = {0.507, 1.513, 3.004};
constexpr double least_psnr = 45; ///< least PSNR of a reference against a direct render of 64 samples a pixel, dB

/// Link of a viewer: from no limit to links that are narrow, stall, or change their rate.
LinkParameters link_of(int viewer, double seconds) {
    LinkParameters link;
    link.seed = static_cast<std::uint64_t>(viewer) + 1;
    if (viewer % 4 == 1) {
        link = {.bits_per_second = 20e6, .delay_seconds = 0.01, .jitter_seconds = 0.005};
    } else if (viewer % 4 == 2) {
        link = {.bits_per_second = 8e6, .delay_seconds = 0.03, .jitter_seconds = 0.02};
        for (double time = 3; time < seconds; time += 7) {
            link.stalls.push_back({time, 0.6});
        }
    } else if (viewer % 4 == 3) {
        link = {.bits_per_second = 4e6, .delay_seconds = 0.005};
        for (double time = 4; time < seconds; time += 8) {
            link.rate_steps.push_back({time, 1e6});
            link.rate_steps.push_back({time + 2, 10e6});
        }
    }
    return link;
}

std::string server_port(test::ServerProcess const& server) {
    return server.address().substr(server.address().rfind(':') + 1);
}

/// True for a viewer that comes as a page does, in a WebSocket.
bool is_in_browser(int viewer) {
    return viewer % 3 == 2;
}

/// With which a server answers browsers.
struct EmptyPage {
    test::TemporaryFolder folder;

    EmptyPage() { folder.write("index.html", ""); }
};

std::vector<std::string> server_words(BenchScene const& scene, SoakOptions const& options, EmptyPage const& page) {
    char stops[40];
    std::snprintf(stops, sizeof stops, "%.9g", std::log2(static_cast<double>(scene.exposure)));
    return {"--exposure",
            stops,
            "--insecure",
            "--web-files",
            page.folder.path().string(),
            "--session-memory",
            "1000000",
            "--max-sessions",
            std::to_string(options.viewers + 8)};
}

class Soak {
public:
    Soak(BenchScene& scene, SoakOptions const& options)
        : scene_(scene), options_(options), server_(scene.file.string(), server_words(scene, options, page_)),
          port_(static_cast<std::uint16_t>(std::stoi(server_port(server_)))), relay_(port_), strangers_(port_),
          first_descriptors_(holdings().descriptors) {
        for (int i = 0; i < options.viewers; ++i) {
            // Links keep their own time; their stalls and steps go on until the last calm has had all the time that it
            // may take.
            viewers_.push_back(std::make_unique<SoakViewer>(is_in_browser(i) ? relay_.port() : port_,
                                                            link_of(i, options.seconds + 2 * patience),
                                                            options.viewport));
        }
    }

    json run() {
        FigureTable const table({{"s", "/seconds", 6, 0},
                                 {"events", "/events", 6, 0},
                                 {"came back", "/reconnections", 9, 0},
                                 {"rest s", "/rest_seconds", 6, 1},
                                 {"exact", "/exact", 5, 0},
                                 {"server MB", "/resident_bytes", 9, 1, 1e-6},
                                 {"at most", "/most_resident_bytes", 7, 1, 1e-6},
                                 {"descr.", "/descriptors", 6, 0},
                                 {"viewers MB", "/viewers_bytes", 10, 1, 1e-6}});
        json rounds = json::array();
        for (double printed = -1e9; seconds() < options_.seconds && failures_.empty();) {
            int const quarter = std::min(static_cast<int>(4 * seconds() / options_.seconds), 3);
            round_ = quarter == quarter_ ? round_ + 1 : 0;
            quarter_ = quarter;
            rounds.push_back(run_round());
            if (seconds() - printed >= options_.seconds / 60) {
                printed = seconds();
                table.print(rounds.back());
                std::fflush(stdout);
            }
        }
        json figures{{"scene", scene_.name}, {"seed", options_.seed}, {"viewers", options_.viewers}};
        figures["memory"] = judge(rounds, "the server's", "resident_bytes", true);
        figures["viewers_memory"] = judge(rounds, "the viewers'", "viewers_bytes", options_.events == 0);
        figures["rounds"] = std::move(rounds);
        end();
        figures["failures"] = failures_;
        return figures;
    }

private:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }
    ProcessHoldings holdings() { return holdings_of(server_.process().pid()); }

    void fail(std::string const& what) {
        char when[80];
        std::snprintf(when, sizeof when, "after %.1f s, the last storm had --seed %llu: ", seconds(),
                      static_cast<unsigned long long>(storm_seed_));
        failures_.push_back(when + what);
        std::printf("FAILED %s\n", failures_.back().c_str());
    }

    json run_round() {
        storm_seed_ = options_.seed + round_;
        json figures = storm(storm_seed_);
        figures["quarter"] = quarter_;
        double const rest_began = seconds();
        SceneTime const moment = still_times[round_ % std::size(still_times)];
        bool const complete = come_to_rest(moment);
        figures["rest_seconds"] = seconds() - rest_began;
        figures["exact"] = complete ? count_exact(moment) : 0;
        wait_for_descriptors(first_descriptors_ + viewers_.size());
        ProcessHoldings const held = holdings();
        figures["seconds"] = seconds();
        figures["resident_bytes"] = held.resident_bytes;
        figures["descriptors"] = held.descriptors;
        figures["viewers_bytes"] = holdings_of(::getpid()).resident_bytes;
        std::uint64_t reconnections = 0;
        for (auto const& viewer : viewers_) {
            reconnections += viewer->reconnections();
        }
        figures["reconnections"] = reconnections;
        return figures;
    }

    /// Makes a storm. Returns what happened in it.
    json storm(std::uint64_t seed) {
        StormParameters parameters;
        parameters.viewers = options_.viewers;
        parameters.seconds = options_.storm_seconds;
        parameters.viewer_events_per_second *= options_.events;
        parameters.visits_per_second *= options_.events;
        parameters.seed = seed;
        std::vector<StormMoment> const coming = make_storm(parameters);
        double const began = seconds();
        double most_resident = 0;
        std::map<std::string, int> counts;
        auto next = coming.begin();
        for (double now = 0; now < options_.storm_seconds && server_.process().running(); now = seconds() - began) {
            for (; next != coming.end() && next->time <= now; ++next) {
                ++counts[std::string(name_of(next->event))];
                if (is_of_viewer(next->event)) {
                    viewers_[static_cast<std::size_t>(next->viewer)]->take(*next);
                } else {
                    strangers_.add(*next, now);
                }
            }
            strangers_.pass_time(now);
            for (std::size_t i = 0; i < viewers_.size(); ++i) {
                viewers_[i]->move(seconds(), options_.flight, scene_camera_of(i));
            }
            most_resident = std::max(most_resident, holdings().resident_bytes);
            std::this_thread::sleep_for(step);
        }
        strangers_.end_all();
        return {{"seed", seed},
                {"events", next - coming.begin()},
                {"kinds", counts},
                {"most_resident_bytes", most_resident}};
    }

    /// The camera of the scene that a viewer looks through: every other one through one that moves.
    int scene_camera_of(std::size_t viewer) const {
        int const count = static_cast<int>(scene_.scene.cameras.size());
        for (int i = 0; i < count && viewer % 2 == 1 && !options_.flight; ++i) {
            if (scene_.posed->camera_moves(i)) {
                return i;
            }
        }
        return -1;
    }

    StillView view_of(std::size_t viewer, SceneTime moment) const {
        auto const number = static_cast<int>(viewer);
        if (options_.flight) {
            return {options_.flight->at(options_.flight->duration() * (number + 1) / (options_.viewers + 1)), -1,
                    options_.viewport, moment};
        }
        CameraTurn const turn{5, 80};
        Camera const camera = turned(viewers_.front()->start_camera(), turn, number);
        return {camera, scene_camera_of(viewer), {160 + 17 * number, 90 + 9 * number}, moment};
    }

    /// Waits until all pictures are complete; false where that never comes.
    bool come_to_rest(SceneTime moment) {
        double const began = seconds();
        bool complete = false;
        while (!complete) {
            complete = true;
            for (std::size_t i = 0; i < viewers_.size(); ++i) {
                bool const rests = viewers_[i]->come_to_rest(view_of(i, moment));
                complete = complete && rests;
                if (std::string const reason = viewers_[i]->end_reason(); !reason.empty()) {
                    fail("viewer " + std::to_string(i) + " has ended: " + reason);
                    return false;
                }
                if (!rests && seconds() - began > patience) {
                    fail("the picture of viewer " + std::to_string(i) + " is not complete");
                    return false;
                }
            }
            if (!server_.process().running()) {
                fail("the server has ended: " + server_.process().errors());
                return false;
            }
            std::this_thread::sleep_for(step);
        }
        return true;
    }

    /// Difference of two pictures in words.
    static std::string difference(Picture const& one, Picture const& other) {
        if (one.rgba.size() != other.rgba.size()) {
            return "another size";
        }
        std::size_t count = 0;
        int most = 0;
        for (std::size_t i = 0; i < one.rgba.size(); ++i) {
            int const bytes = std::abs(int{one.rgba[i]} - int{other.rgba[i]});
            count += bytes > 0 ? 1 : 0;
            most = std::max(most, bytes);
        }
        return std::to_string(count) + " bytes differ, by " + std::to_string(most) + " at most";
    }

    /// Number of viewers that show exactly what they should.
    std::size_t count_exact(SceneTime moment) {
        std::size_t exact = 0;
        for (std::size_t i = 0; i < viewers_.size(); ++i) {
            bool const equal = viewers_[i]->picture() == reference(i, moment);
            exact += equal ? 1 : 0;
            if (!equal) {
                fail("the picture of viewer " + std::to_string(i) +
                     " is not the reference: " + difference(viewers_[i]->picture(), reference(i, moment)));
            }
        }
        return exact;
    }

    /// Picture of a viewer that has seen nothing else but this view.
    Picture const& reference(std::size_t viewer, SceneTime moment) {
        Picture& reference = references_[{viewer, moment}];
        if (reference.width > 0) {
            return reference;
        }
        StillView const view = view_of(viewer, moment);
        SoakViewer fresh(port_, {}, view.viewport);
        double const began = seconds();
        while (!fresh.come_to_rest(view)) {
            if (seconds() - began > patience) {
                fail("the reference of viewer " + std::to_string(viewer) + " is not complete");
                break;
            }
            std::this_thread::sleep_for(step);
        }
        reference = fresh.picture();
        pose_at(scene_, moment);
        Camera const camera =
            view.scene_camera >= 0 ? scene_.posed->camera(static_cast<Index>(view.scene_camera), moment) : view.camera;
        double const psnr = psnr_from_mse(mean_squared_error(
            reference, render_picture(*scene_.render_scene, camera, view.viewport, scene_.exposure, 8)));
        if (psnr < least_psnr) {
            fail("the reference of viewer " + std::to_string(viewer) + " is " + std::to_string(psnr) +
                 " dB off the direct render");
        }
        return reference;
    }

    /// Waits until the server has so many descriptors: connections that have ended are closed a moment later.
    void wait_for_descriptors(std::size_t count) {
        double const began = seconds();
        while (holdings().descriptors != count && seconds() - began < patience / 4) {
            std::this_thread::sleep_for(step);
        }
        if (std::size_t const open = holdings().descriptors; open != count) {
            fail("the server has " + std::to_string(open) + " descriptors open and not " + std::to_string(count));
        }
    }

    /// Judges what a figure of the calms says of memory. That of viewers depends on the sizes that events give them: it
    /// can fail only where there are no events.
    json judge(json const& rounds, char const* whose, char const* key, bool can_fail) {
        std::array<std::vector<double>, 4> bytes;
        for (json const& round : rounds) {
            bytes[round["quarter"].get<std::size_t>()].push_back(round[key]);
        }
        MemoryJudgement const judgement = judge_memory(bytes, whose);
        std::printf("%s: %s\n", scene_.name.c_str(), judgement.text.c_str());
        if (!judgement.growth) {
            return {{"judged", false}};
        }
        if (can_fail && judgement.grows) {
            fail(std::string(whose) + " memory grows");
        }
        return {{"judged", can_fail},
                {"bytes_a_quarter", judgement.growth->mean},
                {"standard_error", judgement.growth->error},
                {"mean_bytes", judgement.growth->before},
                {"pairs", judgement.growth->pairs}};
    }

    void end() {
        viewers_.clear();
        if (!server_.process().running()) {
            return; // this has been reported
        }
        wait_for_descriptors(first_descriptors_);
        server_.process().signal(SIGTERM);
        if (int const code = server_.process().wait(std::chrono::seconds(60)); code != 0) {
            fail("the server ended with " + std::to_string(code) + ": " + server_.process().errors());
        }
    }

    BenchScene& scene_;
    SoakOptions const options_;
    EmptyPage page_;
    test::ServerProcess server_;
    std::uint16_t const port_;
    WebRelay relay_;
    Strangers strangers_;
    std::size_t const first_descriptors_;
    Clock::time_point const begun_ = Clock::now();
    std::vector<std::unique_ptr<SoakViewer>> viewers_;
    std::map<std::pair<std::size_t, SceneTime>, Picture> references_;
    int quarter_ = -1; ///< quarter of the time that this round belongs to
    std::size_t round_ = 0; ///< number of the round in its quarter
    std::uint64_t storm_seed_ = 0;
    std::vector<std::string> failures_;
};

} // namespace

json run_soak(BenchScene& scene, SoakOptions const& options) {
    std::printf("%s, %d viewers, %g s, seed %llu\n", scene.name.c_str(), options.viewers, options.seconds,
                static_cast<unsigned long long>(options.seed));
    return Soak(scene, options).run();
}

} // namespace framelet::bench
