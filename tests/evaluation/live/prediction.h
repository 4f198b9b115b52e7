// What the virtual clock says of a session of the real programs that had a core each. In: scene, method, when the session
// began. Out: error, bytes and pictures as `live` measures them. That both agree is what makes the virtual clock's charts
// worth something.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/live/live.h"

namespace framelet::bench {

/// `method`: framelet's own. `start`: scene time at which the viewer came. The table of costs is calibrated on the same
/// session first, on this machine.
nlohmann::json predict_live(BenchScene& scene, std::string const& method, LiveOptions const& options, SceneTime start);

} // namespace framelet::bench
