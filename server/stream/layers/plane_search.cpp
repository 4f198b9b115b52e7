#include "server/stream/layers/plane_search.h"

#include <cmath>

namespace framelet {
namespace {

/// Fits a plane to its own members again and again, while that wins any.
void grow(GridFloats const& values, GridFloats const& candidates, float tolerance, FoundPlane& found) {
    constexpr int most_rounds = 6;
    found.count = find_members(values, candidates, found.plane, 2 * tolerance, found.members);
    for (int round = 0; round < most_rounds; ++round) {
        int const before = found.count;
        found.plane = least_squares(moments_of(values, found.members));
        found.count = find_members(values, candidates, found.plane, 1.5f * tolerance, found.members);
        if (found.count <= before) {
            break;
        }
    }
    found.plane = least_squares(moments_of(values, found.members));
    found.count = find_members(values, candidates, found.plane, tolerance, found.members);
}

bool is_planar(GridFloats const& values, GridFloats const& candidates, GridPlane const& plane, int block,
               float tolerance) {
    for (int i = block; i < framelet_samples; i += grid_blocks) {
        if (candidates[i] != 0 && !(std::abs(residual(values, plane, i)) <= tolerance)) {
            return false;
        }
    }
    return true;
}

void grow_from_blocks(GridFloats const& values, GridFloats const& candidates, BlockMoments const& moments,
                      float tolerance, FoundPlane& best) {
    constexpr float least_block_samples = 6;
    std::array<bool, grid_blocks> taken{}; // by a plane that was grown from another
    FoundPlane found;
    for (int seed = 0; seed < grid_blocks; ++seed) {
        auto const s = static_cast<std::size_t>(seed);
        if (taken[s] || moments.block[s].n < least_block_samples) {
            continue;
        }
        found.plane = least_squares(moments.block[s]);
        if (!is_planar(values, candidates, found.plane, seed, tolerance)) {
            continue;
        }
        grow(values, candidates, tolerance, found);
        if (found.count > best.count) {
            best = found;
        }
        if (2 * static_cast<float>(best.count) > moments.total.n) {
            return; // the majority: no other has more
        }
        for (int block = seed + 1; block < grid_blocks; ++block) {
            float members = 0;
            for (int i = block; i < framelet_samples; i += grid_blocks) {
                members += found.members[i];
            }
            auto const b = static_cast<std::size_t>(block);
            taken[b] = taken[b] || 2 * members > moments.block[b].n;
        }
    }
}

void trim(GridFloats const& values, GridFloats const& candidates, GridPlane const& start, float off, float tolerance,
          FoundPlane& found) {
    found.plane = start;
    for (float within = 0.5f * off; within > 2 * tolerance; within *= 0.5f) {
        found.count = find_members(values, candidates, found.plane, within, found.members);
        if (found.count < least_plane_samples) {
            return;
        }
        found.plane = least_squares(moments_of(values, found.members));
    }
    grow(values, candidates, tolerance, found);
}

/// Takes the members of a plane with even errors to both sides.
bool take_all(GridFloats const& values, GridFloats const& candidates, Moments const& moments, float tolerance,
              FoundPlane& found, Range& range) {
    found.plane = least_squares(moments);
    range = residual_range(values, candidates, found.plane);
    found.plane.centre += range.middle();
    if (!(range.half_width() <= tolerance)) {
        return false;
    }
    found.members = candidates;
    found.count = static_cast<int>(moments.n);
    return true;
}

} // namespace

void find_plane(GridFloats const& values, GridFloats const& candidates, float tolerance, FoundPlane& found) {
    BlockMoments const moments = block_moments_of(values, candidates);
    Range range;
    if (!take_all(values, candidates, moments.total, tolerance, found, range)) {
        GridPlane const start = found.plane;
        found.count = 0;
        grow_from_blocks(values, candidates, moments, tolerance, found);
        if (found.count < least_plane_samples) {
            trim(values, candidates, start, range.half_width(), tolerance, found);
        }
    }
    if (found.count < least_plane_samples) {
        found.count = 0;
    }
}

} // namespace framelet
