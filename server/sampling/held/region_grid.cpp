#include "server/sampling/held/region_grid.h"

#include <algorithm>

#include "common/error.h"

namespace framelet {

RegionGrid::RegionGrid(ImagePlane plane) : plane_(plane), depth_(region_depth(plane)) {
    regions_.resize(std::size_t{1} << (2 * depth_));
    pixels_.resize(regions_.size());
    Viewport const viewport = plane_.viewport();
    for (std::uint32_t i = 0; i < regions_.size(); ++i) {
        PixelRect const rect = rect_of(i);
        int const width = std::min(rect.right, viewport.width) - rect.left;
        int const height = std::min(rect.bottom, viewport.height) - rect.top;
        if (width > 0 && height > 0) {
            visible_.push_back(i);
            pixels_[i] = static_cast<float>(width) * static_cast<float>(height);
        }
    }
}

std::span<Region> RegionGrid::operator[](Patch const& patch) {
    int const levels = depth_ - patch.node.depth();
    FRAMELET_CHECK(levels >= 0);
    return std::span(regions_).subspan(first_under(patch.node), std::size_t{1} << (2 * levels));
}

void RegionGrid::take(Patch const& patch, double now, int rays_per_sample) {
    for (Region& region : (*this)[patch]) {
        region.taken = {shown_level(level_of(patch.depth), rays_per_sample), now};
    }
}

void RegionGrid::note_held(Patch const& patch, double when, int rays_per_sample) {
    for (Region& region : (*this)[patch]) {
        region.level = level_of(patch.depth);
        region.rays_per_sample = rays_per_sample;
        region.rendered = when;
        if (region.taken.when == when) {
            region.taken = {};
        }
    }
}

} // namespace framelet
