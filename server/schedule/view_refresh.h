// What one viewer's picture gets next: starts anew when what is seen changes, refines while it stays. In: what is to be
// seen, how many samples a cycle has time for. Out: the tiles of the next batch.
#pragma once

#include <optional>
#include <vector>

#include "common/framelet.h"
#include "server/schedule/refinement.h"
#include "server/schedule/view_state.h"

namespace framelet {

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
