// One picture that shows several methods beside the reference, each with its error below.
#pragma once

#include <span>
#include <string>

#include "common/image.h"

namespace framelet::bench {

struct Labelled {
    std::string label; ///< UTF-8, one line: "framelet, MSE 1.2e-4"
    Picture picture;
};

/// What an error is multiplied by before it is coloured: 255 / 4 and more is the brightest colour.
inline constexpr int error_gain = 4;

/// A column for the reference and one for each of `shown`: label, picture at its own size, and below it the root mean
/// square of the three bytes' differences from the reference, times `error_gain`, from black over red to yellow. Below
/// the reference stands the scale. InputError where a picture differs from the reference in size or the reference is
/// empty.
Picture side_by_side(Picture const& reference, std::span<Labelled const> shown);

} // namespace framelet::bench
