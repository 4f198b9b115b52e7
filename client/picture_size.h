// The size of a picture as a user writes it.
#pragma once

#include <string>

#include "common/camera.h"

namespace framelet {

/// Reads WIDTHxHEIGHT. Throws InputError.
Viewport parse_size(std::string const& text);

} // namespace framelet
