// What it buys, and costs, to show the scene a little late and mix what comes before that moment with what comes after
// it. In: scenes, lags. Out: error and unsteadiness of `framelet`'s pictures on the virtual clock.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

struct SmoothnessStudy {
    std::vector<std::filesystem::path> scenes;
    std::vector<double> lags_ms{0, 50, 100, 200};
};

/// How unsteadily a sequence of pictures goes on: mean over pixels, RGB in [0, 1] and all pictures but the first and
/// the last of the squared second difference in time, p(t+1) - 2 p(t) + p(t-1). Of at least three pictures of one size.
double mean_squared_second_difference(std::span<Picture const> pictures);
/// The same of the pictures' differences from as many others, of the same times: 0 where the error never changes, or
/// does so evenly.
double mean_squared_second_difference(std::span<Picture const> pictures, std::span<Picture const> reference);

/// One row a scene and lag: MSE against the scene as it is, against the scene as it is to be shown (the lag earlier,
/// with the same camera), and how unsteady the pictures are against the latter. `options.samples_per_side` are the
/// references'. Charts: for each scene and lag a picture of the middle of the run beside the one that was to be shown,
/// and two more, each two pictures later.
nlohmann::json measure_smoothness(SmoothnessStudy const& study, StudyOptions const& options);

} // namespace framelet::bench
