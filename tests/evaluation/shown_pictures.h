// One run of one method with everything that it showed: for studies that look at the pictures in more ways than one.
#pragma once

#include <string>
#include <vector>

#include "tests/evaluation/reference.h"
#include "tests/evaluation/run.h"

namespace framelet::bench {

struct ShownPictures {
    RunResult run;
    RivalParts rivals; ///< as it was run
    std::vector<Picture> pictures; ///< one a reference time
};

ShownPictures show_method(BenchScene& scene, std::string const& method, RunParameters const& parameters, double machine,
                          CostTable const& costs);

/// The same of the choice with the least mean error against `truth` (one a reference time), where the parameters leave
/// one to a rival.
ShownPictures show_best(BenchScene& scene, std::string const& method, RunParameters const& parameters, double machine,
                        CostTable const& costs, std::vector<Picture> const& truth);

/// The first `count` pictures, all in memory: width * height * 4 bytes each.
std::vector<Picture> read_pictures(Reference const& reference, std::size_t count);

/// MSE of each against the reference of the same time.
std::vector<double> errors_of(std::vector<Picture> const& shown, std::vector<Picture> const& reference);

/// Of at least one number; of an even number of them the greater one in the middle.
double median_of(std::vector<double> values);

} // namespace framelet::bench
