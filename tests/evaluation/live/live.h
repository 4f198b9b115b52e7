// Measures what a person gets: server and viewer as real programs, a real socket, the clock running. Every method runs
// so, the rivals too. In: a scene, a camera, a size, a link. Out: for each method how many pictures it showed, how far
// off they were from what was to be shown at that moment, and what they cost.
#pragma once

#include <filesystem>
#include <memory>
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
    std::filesystem::path camera_file; ///< camera file as framelet-client takes it; empty: the scene's own camera
    LinkParameters link; ///< link to emulate; without limit and delay: none is emulated
    bool pinned = false; ///< server and viewer have a core each
    int moments = 4; ///< number of moments at which pictures are compared
    int runs = 1; ///< of each method: figures are those of the run of median error
    bool steadiness = true; ///< is measured, which takes three references at every other moment
    int samples_per_side = 4; ///< samples along a side of the reference's pixel: 1, 2, 4 or 8
    std::string light = "direct"; ///< of all methods, as framelet-server takes it; else than direct: against paths
    int paths = 64; ///< of each pixel of such a reference
    std::filesystem::path charts; ///< folder for pictures beside their reference; empty: none
    /// True: runs framelet's own methods on the virtual clock as well; needs `pinned` and no camera file.
    bool predicts = false;
    CostTable costs; ///< table from which the virtual clock starts
};

/// Seconds from the first picture on in which methods build up what they hold, and nothing is compared.
inline constexpr double build_up_seconds = 1;

/// Loads a scene for `measure_live`, where light other than direct is compared with that of paths.
std::unique_ptr<BenchScene> load_live_scene(std::filesystem::path const& file, std::string const& light);

/// Runs all methods, prints and returns their figures; `psnr_low` and `psnr_high` are those of the worst and the best
/// run. Throws InputError or ConnectionError where a program fails.
nlohmann::json measure_live(BenchScene& scene, LiveOptions const& options);

} // namespace framelet::bench
