// What one viewer's picture gets next: starts anew when what is seen changes, refines while it stays. In: what is to be
// seen, how many samples a cycle has time for. Out: the tiles of the next batch.
#pragma once

#include <optional>
#include <vector>

#include "common/framelet.h"
#include "server/schedule/refinement.h"

namespace framelet {

/// What is on screen is worth refining for as long as this stays the same.
struct ViewState {
    NumberedView view;
    float exposure = 1;
    SceneTime scene_time = 0; ///< 0 where nothing moves

    bool operator==(ViewState const&) const = default;
};

/// How far one viewer's picture has come.
struct ViewRefresh {
    std::optional<ViewState> seen;
    ImagePlane plane;
    Refinement refinement;
};

/// True when the picture of `state` is complete: `next_tiles` would return nothing.
bool is_complete(ViewRefresh const& refresh, ViewState const& state);

/// The tiles of the next batch, of `refresh.plane`. `affordable`: samples that a cycle has time for. `batch_framelets`:
/// most framelets of one batch; 0: what `affordable` says. A view that has just changed is shown whole, or it would be
/// torn; afterwards a cycle's worth at a time.
std::vector<Tile> next_tiles(ViewRefresh& refresh, ViewState const& state, double affordable,
                             std::size_t batch_framelets);

} // namespace framelet
