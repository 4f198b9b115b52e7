// How far the loading of a scene is.
#pragma once

#include <functional>
#include <string_view>

namespace framelet {

/// Told what is being done and how much of it, 0..1. Calls may come from any thread, one at a time.
using Progress = std::function<void(std::string_view what, double fraction)>;

} // namespace framelet
