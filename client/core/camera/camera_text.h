// A camera as text, for files and for addresses of the web page. In: a camera, the moment that it is of. Out: JSON, as
// camera_path.h reads it; and back out of an address.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "client/core/camera/camera_path.h"
#include "common/camera.h"

namespace framelet {

/// The camera, and the moment that it is of, as --camera reads them, with a line's end; `origin` of the scene as in
/// Welcome.
std::string camera_file_text(Camera const& camera, CameraMoment const& moment,
                             glm::dvec3 const& origin = glm::dvec3(0));

/// The text that an address of the page has behind #camera= or &camera=; nothing where it has none.
std::optional<std::string> camera_in_address(std::string_view address);

} // namespace framelet
