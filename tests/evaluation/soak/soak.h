// Runs a server in bad weather, for as long as it is told: the real program, viewers that stay, and strangers that come
// and go. Rounds of a storm and a calm; in each calm every viewer that stays must show the exact picture, and the
// server must hold what it held before.
#pragma once

#include <cstdint>
#include <optional>

#include <nlohmann/json_fwd.hpp>

#include "client/core/camera/camera_path.h"
#include "tests/evaluation/bench_scene.h"

namespace framelet::bench {

struct SoakOptions {
    int viewers = 8; ///< number of viewers that stay; every third comes as a page does, in a WebSocket
    double seconds = 3600;
    double storm_seconds = 6; ///< length of each round's storm, seconds; its calm takes as long as the pictures do
    double events = 1; ///< frequency of events in storms, as a multiple of the usual; 0: viewers only fly
    Viewport viewport{320, 180}; ///< viewport of viewers until an event resizes them
    /// Camera path that viewers fly in storms, there and back; empty: they look around from where the scene is seen
    /// first, every other one through a camera of the scene that moves.
    std::optional<CameraPath> flight;
    std::uint64_t seed = 1;
};

/// Prints a row a round (sixty at most, spread evenly) and what has failed, each in one line, and returns the figures,
/// of which "failures" is empty where all is well. It checks:
/// - in each calm: whether every viewer's picture is complete within two minutes, and equal to that of a viewer who
///   came for it over a link without limit, which is a direct render's but for what its samples are quantised to;
///   whether the server's descriptors are those of its viewers and no more;
/// - in the calms of the last quarter of the time: whether the server holds more resident memory than in those of the
///   quarter before (`judge_memory`), and, where viewers only fly, whether they do. The same storms come in each
///   quarter, since what a calm holds depends on the storm before it. A line says where there were too few calms;
/// - at the end: whether without viewers it has the descriptors that it had at first, and ends without an error.
nlohmann::json run_soak(BenchScene& scene, SoakOptions const& options);

} // namespace framelet::bench
