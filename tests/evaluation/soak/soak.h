// A server in bad weather, for as long as it is told: the real program, viewers that stay, and strangers that come and
// go. Rounds of a storm and a calm; in each calm every viewer that stays shows the exact picture, and the server holds
// what it held before.
#pragma once

#include <cstdint>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/bench_scene.h"

namespace framelet::bench {

struct SoakOptions {
    int viewers = 8; ///< that stay
    double seconds = 3600;
    double storm_seconds = 6; ///< of each round; its calm takes as long as the pictures do
    std::uint64_t seed = 1;
};

/// Prints a row a round (sixty at most, spread evenly) and what has failed, each in one line, and returns the figures,
/// of which "failures" is empty where all is well. What is looked at:
/// - in each calm: whether every viewer's picture is complete within two minutes, and equal to that of a viewer who
///   came for it over a link without limit, which is a direct render's but for what its samples are quantised to;
///   whether the server's descriptors are those of its viewers and no more;
/// - over the second half's calms: whether the server's resident memory grows (`grows`);
/// - at the end: whether without viewers it has the descriptors that it had at first, and ends without an error.
nlohmann::json run_soak(BenchScene& scene, SoakOptions const& options);

} // namespace framelet::bench
