#include "server/schedule/view_refresh.h"

#include <algorithm>

namespace framelet {

bool is_complete(ViewRefresh const& refresh, ViewState const& state) {
    return refresh.seen == state && is_converged(refresh.refinement);
}

std::vector<Tile> next_tiles(ViewRefresh& refresh, ViewState const& state, double affordable,
                             std::size_t batch_framelets) {
    bool const changed = refresh.seen != state;
    if (changed) {
        refresh.plane = ImagePlane(state.view.viewport);
        refresh.refinement = start_refinement(refresh.plane, deepest_affordable(refresh.plane, affordable));
        refresh.seen = state;
    }
    std::size_t const timely = static_cast<std::size_t>(affordable / framelet_samples) + 1;
    std::size_t const limit = batch_framelets > 0 ? batch_framelets : changed ? max_batch_framelets : timely;
    return select_tiles(refresh.refinement, std::min(limit, max_batch_framelets));
}

} // namespace framelet
