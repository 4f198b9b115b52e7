// The verbs of real programs: `live`, what its processes run (`serve`, `look`), `soak`, `replay`, and `link`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/live/crowd.h"
#include "tests/evaluation/live/live.h"
#include "tests/evaluation/live/scale.h"
#include "tests/evaluation/live/serve.h"
#include "tests/evaluation/soak/soak.h"

namespace CLI {
class App;
}

namespace framelet::bench {

struct LiveVerbOptions {
    std::vector<std::filesystem::path> scenes; ///< empty: the bundled ones
    std::string size = "1280x720";
    double megabits = 0, delay_ms = 0;
    LiveOptions live;
    CrowdOptions crowd;
    ServeOptions serve;
    LookOptions look;
    std::string server; ///< server's address for `look`, HOST:PORT
    std::filesystem::path recording;
    std::uint16_t link_to = 0; ///< port of the server behind `link`
    SoakOptions soak;
    std::string soak_size = "320x180";
    ScaleOptions scale;
    std::string scale_size = "640x360";
};

// The options that these functions bind must outlive the parsing.

void add_live_options(CLI::App& verb, LiveVerbOptions& options);
void add_serve_options(CLI::App& verb, LiveVerbOptions& options);
void add_look_options(CLI::App& verb, LiveVerbOptions& options);
void add_replay_options(CLI::App& verb, LiveVerbOptions& options);
void add_soak_options(CLI::App& verb, LiveVerbOptions& options);
void add_scale_options(CLI::App& verb, LiveVerbOptions& options);
void add_link_verb_options(CLI::App& verb, LiveVerbOptions& options);

nlohmann::json answer_live(LiveVerbOptions& options, std::vector<std::filesystem::path> const& bundled,
                           std::filesystem::path const& costs_file);
nlohmann::json answer_serve(LiveVerbOptions& options, std::filesystem::path const& costs_file);
nlohmann::json answer_look(LiveVerbOptions& options, std::filesystem::path const& costs_file);
/// Replays a recorded session. Throws InputError where the replayed bytes are others than the recorded ones.
nlohmann::json answer_replay(LiveVerbOptions& options);
/// Runs `soak` on each scene; several share the time. `usual`: the scene where none is named. Throws ConnectionError
/// where something has failed.
nlohmann::json answer_soak(LiveVerbOptions& options, std::filesystem::path const& usual);
/// Measures what workers buy; `usual`: the scene where none is named.
nlohmann::json answer_scale(LiveVerbOptions& options, std::filesystem::path const& usual,
                            std::filesystem::path const& costs_file);
/// Says at which port an emulated link begins, and lets bytes through until standard input ends.
nlohmann::json answer_link(LiveVerbOptions& options);

} // namespace framelet::bench
