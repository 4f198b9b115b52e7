// What a person gets: server and viewer as real programs, a real socket, the clock running. Every method runs so, the
// rivals too. In: a scene, a camera, a size, a link. Out: for each method how many pictures it showed, how far off they
// were from what was to be shown at that moment, and what they cost.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/bench_scene.h"
#include "tests/evaluation/codecs/simulated_link.h"
#include "tests/evaluation/cost_table.h"

namespace framelet::bench {

struct LiveOptions {
    std::vector<std::string> methods{"framelet", "framelet-unwarped", "framed", "framed+h264", "framed+warp"};
    Viewport viewport{1280, 720};
    double seconds = 4;
    std::filesystem::path camera_file; ///< as framelet-client takes it; empty: the scene's own camera
    LinkParameters link; ///< no limit and no delay: none is emulated
    bool pinned = false; ///< server and viewer on a core each
    int moments = 4; ///< at which pictures are compared
    int samples_per_side = 4; ///< of the reference: 1, 2, 4 or 8
    std::filesystem::path charts; ///< folder for pictures beside their reference; empty: none
    bool predicts = false; ///< beside framelet's own methods what the virtual clock says of them, a core each
    CostTable costs; ///< for that
};

/// From the first picture on: until then the methods build up what they hold, and nothing is compared.
inline constexpr double build_up_seconds = 1;

/// Prints and returns the figures of all methods. Throws InputError or ConnectionError where a program fails.
nlohmann::json measure_live(BenchScene& scene, LiveOptions const& options);

} // namespace framelet::bench
