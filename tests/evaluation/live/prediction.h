// What the virtual clock says of a session of the real programs that had a core each. In: scene, method, what the
// session took. Out: error, bytes and pictures as `live` measures them. That both agree is what makes the virtual clock's charts
// worth something.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/live/live.h"

namespace framelet::bench {

/// `method`: framelet's own. `measured`: what `live` says of that session, whose processes say how fast the machine was.
nlohmann::json predict_live(BenchScene& scene, std::string const& method, LiveOptions const& options,
                            nlohmann::json const& measured);

} // namespace framelet::bench
