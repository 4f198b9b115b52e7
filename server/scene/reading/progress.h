// Reports how far the loading of a scene is.
#pragma once

#include <functional>
#include <string_view>

namespace framelet {

/// A function that is told what is being done and what fraction of it is done, 0..1. Calls may come from any thread,
/// one at a time. It may throw, which ends the loading.
using Progress = std::function<void(std::string_view what, double fraction)>;

} // namespace framelet
