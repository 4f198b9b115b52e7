// OpenEXR files of float channels, written without its library, which the viewer would need for nothing else. In: a
// picture and how deep its pixels are. Out: the file's bytes, by "OpenEXR File Layout": one part, scan lines, not
// compressed.
#pragma once

#include <span>
#include <string>

#include "common/image.h"

namespace framelet {

/// Channels R, G, B: linear light of Rec.709 primaries, as the picture shows it: [0, 1]. `depths`: channel Z, in the
/// order of the pixels; none: there is no such channel.
std::string exr_bytes(Picture const& picture, std::span<float const> depths);

} // namespace framelet
