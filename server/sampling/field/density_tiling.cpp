#include "server/sampling/field/density_tiling.h"

#include <cmath>

#include "common/error.h"

namespace framelet {
namespace {

constexpr double steps_per_sample = 256;
constexpr std::uint64_t most_of_a_tile = static_cast<std::uint64_t>(2 * framelet_samples * steps_per_sample);

class Cut {
public:
    Cut(ImagePlane const& plane, int depth, std::span<std::uint64_t const> sums)
        : plane_(plane), depth_(depth), sums_(sums) {}

    void descend(Tile node, std::vector<Patch>& out) const {
        if (!plane_.is_visible(node)) {
            return;
        }
        bool const is_element = node.depth() == depth_;
        if (node.depth() >= plane_.min_depth() && integral(node) <= most_of_a_tile) {
            out.push_back({node, node.depth()});
        } else if (is_element) {
            out.push_back({node, depth_within(node)});
        } else {
            for (std::uint32_t quadrant = 0; quadrant < 4; ++quadrant) {
                descend(node.child(quadrant), out);
            }
        }
    }

private:
    std::uint64_t integral(Tile node) const {
        int const shift = 2 * (depth_ - node.depth());
        std::size_t const first = std::size_t{node.index()} << shift;
        return sums_[first + (std::size_t{1} << shift)] - sums_[first];
    }

    /// Depth of the tiles that an element is cut into, because it is worth more than one tile or larger than the
    /// coarsest ones.
    int depth_within(Tile element) const {
        std::uint64_t samples = integral(element);
        int depth = element.depth();
        while ((samples > most_of_a_tile && depth < plane_.max_depth()) || depth < plane_.min_depth()) {
            samples /= 4;
            ++depth;
        }
        return depth;
    }

    ImagePlane const& plane_;
    int depth_;
    std::span<std::uint64_t const> sums_;
};

void sum_up(ImagePlane const& plane, std::span<float const> samples_per_pixel, int depth,
            std::vector<std::uint64_t>& sums) {
    FRAMELET_CHECK(samples_per_pixel.size() == std::size_t{1} << (2 * depth));
    double const side = plane.side() >> depth;
    double const scale = steps_per_sample * side * side;
    sums.resize(samples_per_pixel.size() + 1);
    sums[0] = 0;
    for (std::size_t i = 0; i < samples_per_pixel.size(); ++i) {
        double const samples = plane.is_visible({static_cast<std::uint32_t>(samples_per_pixel.size() + i)})
                                   ? scale * static_cast<double>(samples_per_pixel[i])
                                   : 0;
        sums[i + 1] = sums[i] + static_cast<std::uint64_t>(std::llround(samples));
    }
}

} // namespace

void make_density_patches(ImagePlane const& plane, std::span<float const> samples_per_pixel, int depth,
                          TilingScratch& scratch, std::vector<Patch>& patches) {
    sum_up(plane, samples_per_pixel, depth, scratch.sums);
    patches.clear();
    Cut(plane, depth, scratch.sums).descend(Tile{1}, patches);
}

void append_tiles(ImagePlane const& plane, Patch const& patch, std::vector<Tile>& tiles) {
    int const shift = 2 * (patch.depth - patch.node.depth());
    std::uint32_t const first = patch.node.code << shift;
    for (std::uint32_t i = 0; i < (1u << shift); ++i) {
        if (plane.is_visible({first + i})) {
            tiles.push_back({first + i});
        }
    }
}

} // namespace framelet
