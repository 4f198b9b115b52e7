// Samples directions of an environment by how bright it is there. In: an environment. Out: directions and densities.
#pragma once

#include <vector>

#include "server/render/light/environment.h"

namespace framelet {

class SkyTable {
public:
    explicit SkyTable(Environment const& environment);

    /// True where the environment sends no light at all.
    bool black() const { return rows_.empty(); }
    Vec3 sample(Vec2 random) const;
    /// Density of a unit direction, 1 / sr.
    float density(Vec3 const& direction) const;

private:
    std::vector<float> rows_; ///< sums of rows' shares of light; the last is 1
    std::vector<float> columns_; ///< of each row: sums of its texels' shares of the row
};

} // namespace framelet
