// A record of the light cache: what arrives at a place of a surface from all around, but from punctual lights. In: sums
// over paths that were gathered there. Out: what is shown.
#pragma once

#include <array>
#include <compare>
#include <cstdint>

#include "common/math.h"

namespace framelet {

/// Light that arrives at a surface, without that of punctual lights.
struct IncomingLight {
    Vec3 all{0}; ///< irradiance / pi: what a white Lambertian surface reflects
    Vec3 reflected{0}; ///< the part of `all` that comes from surfaces, not from the environment
    Vec3 lean{0}; ///< mean over cosine-distributed unit directions, along the surface, of luminance * direction
    float open = 0; ///< share of the environment that is seen, cosine-weighted

    void add(IncomingLight const& other, float weight) {
        all += other.all * weight;
        reflected += other.reflected * weight;
        lean += other.lean * weight;
        open += other.open * weight;
    }
};

/// A point of a surface, in the frame of what carries it.
struct LightPlace {
    std::uint32_t frame = 0; ///< 0: the world; else the number of a moving instance + 1
    Vec3 position{0}; ///< metres, a little off the surface, where rays leave it
    Vec3 normal{0, 1, 0}; ///< unit, of the facet
};

/// Which places share a record: those in one cell of a frame that face the same way.
struct CellKey {
    std::array<std::int32_t, 3> cell{}; ///< in cells
    std::uint32_t kind = ~0u; ///< level, main axis of the normal, frame

    /// Written out: of the array alone GCC makes a call of memcmp, which was a twelfth of a server's time.
    bool operator==(CellKey const& other) const {
        return kind == other.kind && cell[0] == other.cell[0] && cell[1] == other.cell[1] && cell[2] == other.cell[2];
    }
};

/// What paths from one place have brought.
struct GatheredLight {
    IncomingLight sum; ///< of all paths
    float squares = 0; ///< sum of the squared luminance of paths
    float nearness = 0; ///< sum of 1 / metres to what the first rays met
    float excess = 0; ///< luminance of bright paths beyond what counts of them in `sum`
    float paths = 0;

    void scale(float share) {
        IncomingLight const all = sum;
        sum = {};
        sum.add(all, share);
        squares *= share;
        nearness *= share;
        excess *= share;
        paths *= share;
    }
    void add(GatheredLight const& other) {
        sum.add(other.sum, 1);
        squares += other.squares;
        nearness += other.nearness;
        excess += other.excess;
        paths += other.paths;
    }
};

struct LightRecord {
    // What is looked up at samples; the rest is for learning.
    CellKey key;
    LightPlace place; ///< from which paths are gathered
    IncomingLight shown; ///< smooth first: where little is gathered it is its parent's
    float excess = 0; ///< of `shown`: what bright paths add to the rest, as a share of that
    bool known = false; ///< `shown` says something
    std::uint32_t used = 0; ///< when it was looked up last, in rounds
    std::uint32_t uses = 0; ///< how often
    std::uint32_t parent = ~0u; ///< number of the record of the coarser cell around it; ~0: it is the coarsest
    GatheredLight gathered; ///< its own and its children's
    float own = 0; ///< paths that left its own place
    float told = 0; ///< of `gathered`: what the cells around it have as well
    float error = 1; ///< standard error of `shown`, as a share of it
    float first = 0; ///< luminance that its first path has brought, the last time that it was followed
    std::uint32_t checked = 0; ///< pose of the scene in which that was
    /// Checks in its cell that were not judged yet, and the sums of what they have found changed, relative to the
    /// light, and of its square.
    float checks = 0, changed = 0, changed_squares = 0;
    /// Sum of the squared changes that checks in its cell, or in one around it, have found, relative to the light
    /// there.
    float change = 0;
    float followed = 0; ///< `change` of its parent of which it knows
};
static_assert(sizeof(LightRecord) <= 200);

} // namespace framelet
