// What the virtual clock says of a session of the real programs that had a core each. In: scene, method, what the
// session took. Out: error, bytes and pictures as `live` measures them. That both agree is what makes the virtual
// clock's charts worth something.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/image.h"
#include "tests/evaluation/live/live.h"

namespace framelet::bench {

/// A moment at which what was shown was compared.
struct ComparedMoment {
    SceneTime time = 0;
    Picture reference;
};

/// `method`: framelet's own. `measured`: what `live` says of that session, whose processes say how fast the machine
/// was. Both are compared at the same moments, of which there must be one at least, in order.
nlohmann::json predict_live(BenchScene& scene, std::string const& method, LiveOptions const& options,
                            nlohmann::json const& measured, std::vector<ComparedMoment> const& moments);

} // namespace framelet::bench
