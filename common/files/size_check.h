// What whoever reads a picture is asked before memory is taken for it.
#pragma once

#include <functional>

namespace framelet {

/// Told the size that the header gives before memory is taken for so many pixels. May throw; that ends the reading.
using SizeCheck = std::function<void(int width, int height)>;

} // namespace framelet
