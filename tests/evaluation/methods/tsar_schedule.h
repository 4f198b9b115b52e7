// Chooses a tiling and the tiles that come next, as [Stephens 2011] places samples (sections 3.4.4.1 and 4.1.6). In:
// sample density. Out: a tiling, and the tiles of the next batch.
#pragma once

#include <span>
#include <vector>

#include "tests/evaluation/methods/response/density_field.h"
#include "tests/uniform_tiling.h"

namespace framelet::bench {

/// Builds a tiling by the serial construction of [Stephens 2011] section 4.1.6.1: a tile whose integral of density is
/// above `most_samples` is replaced by its children, down to the plane's limit; integrals by prefix sums along the
/// Morton curve. `samples_per_pixel`: 4^field_depth elements. The tiles are in the order of the Morton curve, visible
/// ones only.
Tiling make_density_tiling(ImagePlane const& plane, std::span<double const> samples_per_pixel, int field_depth,
                           double most_samples);

/// Indices of at most `count` tiles, those most overdue relative to their own period: greatest (now - refreshed) *
/// rate. `refreshed`: seconds at which each element was refreshed last, `density`: of the same resolution. The indices
/// are in the order of the tiling.
std::vector<std::size_t> select_overdue(std::span<Tile const> tiles, DensityField const& density,
                                        std::span<double const> refreshed, double now, std::size_t count);

} // namespace framelet::bench
