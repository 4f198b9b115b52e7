// Compares what a mirror shows with what is really to be seen of the moment. In: a mirror, and inverse depths or luma
// that were rendered of the moment. Out: positions around which the viewer shows something else; where to look for
// such.
#pragma once

#include <span>
#include <vector>

#include "server/render/probe.h"
#include "server/render/ray_grid.h"
#include "server/sampling/mirror/mirror.h"

namespace framelet {

/// Finds where something nearer is to be seen than the viewer shows. `inverse_depth`: at the positions of the grid, 1 /
/// metres, row by row, < 0 where it is not known. Where neither the cell of a position nor those beside it show
/// anything about as near, the cells around are wrong.
std::vector<CellFault> find_wrong(Mirror const& mirror, RayGrid const& grid, std::span<float const> inverse_depth);

/// Replaces `probes` by one for each position of a grid that shows, well within a surface, what is of another time:
/// with the luma that the viewer shows there. `of_any_time`: of any; such a probe is in the middle of its piece where
/// that is in view, and has the light of it.
void list_probes(Mirror const& mirror, RayGrid const& grid, bool of_any_time, std::vector<Probe>& probes);

/// Finds where the moment looks otherwise than the viewer shows: where what probes really show of the moment differs
/// from that by more than chance, or the light cache says more by now than it did, the cells around are stale.
/// `spacing`: pixels from one probe to the next.
std::vector<CellFault> find_stale(Mirror const& mirror, std::span<Probe const> probes, ProbeLooks const& looks,
                                  int spacing);

} // namespace framelet
