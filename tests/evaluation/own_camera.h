// Measures what a viewer sees of a scene that stands still while its own camera walks through it, or jumps. In: scene,
// the camera's path, size, machine. Out: figures of `framelet` on the virtual clock.
#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/cost_table.h"
#include "tests/evaluation/run.h"

namespace framelet::bench {

struct OwnCameraOptions {
    Viewport viewport{640, 360};
    double walk_machine = 2, jump_machine = 5; ///< samples a displayed pixel and second
    int jumps = 20;
    int samples_per_side = 4; ///< samples along a side of the reference's pixel
    CostTable costs;
};

/// The camera goes along the path at the speed of someone who walks, then stands for a second: `walking_psnr` of the
/// mean error once the walk has lasted for a while, `standing_psnr` at the end of the run. Then it jumps from place to
/// place of the path, turned at random, and stays at each for half a second: the figures are `jumps` and, of those,
/// `steady_jumps`, in which the error never rises by more than 2% above what it had been since the jump, the old
/// picture moved included. Throws InputError.
nlohmann::json measure_own_camera(std::filesystem::path const& scene, std::filesystem::path const& camera,
                                  OwnCameraOptions const& options);

/// True if no value is more than 2% above an earlier one.
bool never_rises(std::vector<double> const& errors);

} // namespace framelet::bench
