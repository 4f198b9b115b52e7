// A check of a picture's size that its reader makes before it takes memory for the pixels.
#pragma once

#include <functional>

namespace framelet {

/// A function that is told the size that the header gives before memory is taken for so many pixels. May throw; that
/// ends the reading.
using SizeCheck = std::function<void(int width, int height)>;

} // namespace framelet
