// What cannot be done from here now, and why: one line for each, which stands in the tooltip of what is grey, and is
// said where a key asks for it. In: what the server offers and how the viewer shows it. Out: the line; empty: it can be
// done.
#pragma once

#include <cstddef>
#include <string>

#include "common/camera.h"

namespace framelet {

/// Of the scene's clock. `is_gone`: there is no session. `moves`: the scene has animation. `controls`: as in Status.
std::string clock_lacks(bool is_gone, bool moves, bool controls);
/// Of cameras of the scene, of which there are so many.
std::string scene_cameras_lack(std::size_t count);
/// Of showing the scene late. `moves_samples`: as `ViewerSettings::reproject`.
std::string smoothing_lacks(bool moves, bool moves_samples);
/// Of drawing over a picture how old its pixels are.
std::string confidence_lacks(bool moves_samples);
/// Of camera files of this camera.
std::string camera_file_lacks(Camera const& camera);
/// Of screenshots and films.
std::string picture_lacks(bool has_picture);

} // namespace framelet
