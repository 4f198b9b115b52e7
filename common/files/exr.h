// OpenEXR files of float channels. In: a picture and how deep its pixels are. Out: the file's bytes: one part, scan
// lines, not compressed.
#pragma once

#include <string>
#include <vector>

#include "common/image.h"

namespace framelet {

/// Channels R, G, B: linear light of Rec.709 primaries, as the picture shows it: [0, 1]. `depths`: channel Z, in the
/// order of the pixels; none: there is no such channel.
std::string exr_bytes(Picture const& picture, std::vector<float> const& depths);

} // namespace framelet
