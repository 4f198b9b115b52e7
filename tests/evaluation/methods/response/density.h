// Sample density of one place, and its bounds.
#pragma once

namespace framelet {

/// Spatial and temporal density ([Stephens 2011] section 6.1): samples per pixel and refreshes in some unit of time.
struct Density {
    double space = 0;
    double time = 0;

    bool operator==(Density const&) const = default;
    /// Combined density ([Stephens 2011] eq. 6.3): what sampling costs.
    double area() const { return space * time; }
};

/// Smallest and greatest densities ([Stephens 2011] eq. 6.10), inclusive: 0 < least <= most.
struct DensityBounds {
    Density least, most;

    bool operator==(DensityBounds const&) const = default;
};

} // namespace framelet
