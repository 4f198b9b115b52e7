// OpenEXR files of float channels. In: a picture and the depths of its pixels. Out: the file's bytes: one part, scan
// lines, not compressed.
#pragma once

#include <string>
#include <vector>

#include "common/image.h"

namespace framelet {

/// Makes the bytes of a file with channels R, G, B: linear light of Rec.709 primaries as the picture shows it, [0, 1].
/// `depths` becomes channel Z, in the order of the pixels, metres; where it is empty there is no such channel.
std::string exr_bytes(Picture const& picture, std::vector<float> const& depths);

/// The same of radiance, not limited to [0, 1].
std::string exr_bytes(FloatImage const& radiance, std::vector<float> const& depths = {});

} // namespace framelet
