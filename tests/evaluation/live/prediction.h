// Predicts on the virtual clock a session of the real programs that had a core each. In: scene, method, what the
// session took. Out: error, bytes and pictures as `live` measures them. Their agreement is what the worth of the
// virtual clock's charts rests on.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/image.h"
#include "tests/evaluation/live/live.h"

namespace framelet::bench {

/// A moment at which the shown picture was compared.
struct ComparedMoment {
    SceneTime time = 0;
    Picture reference;
};

/// Predicts a session. `method`: one of framelet's own. `measured`: the figures of `live` for that session, by which
/// the speed of the machine is known. Both are compared at the same moments, of which there must be one at least, in
/// order.
nlohmann::json predict_live(BenchScene& scene, std::string const& method, LiveOptions const& options,
                            nlohmann::json const& measured, std::vector<ComparedMoment> const& moments);

} // namespace framelet::bench
