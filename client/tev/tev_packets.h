// Packets for the port of the image viewer tev. In: names and pictures. Out: packets as src/Ipc.cpp of tev reads them.
// Each begins with its length, 32 bits, and its kind; numbers are little-endian, texts end with a zero byte.
#pragma once

#include <string>

#include "common/camera.h"
#include "common/image.h"

namespace framelet {

/// The packet that makes an empty image of this size with the channels R, G and B, which tev then shows. `name` without
/// zero bytes.
std::string tev_create_image(std::string const& name, Viewport size);

/// The packet that replaces all of an image that was created. tev takes its values for linear light.
std::string tev_update_image(std::string const& name, Picture const& picture);

} // namespace framelet
