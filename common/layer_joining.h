// Which layers of neighbouring framelets are about one plane: joined from the bottom up in the quadtree of a square,
// first within four framelets, then within four of those. In: layers and where they lie. Out: the planes of what is
// joined, as a forest, so that a picture for which a plane is too rough shows those that it was joined of. None of this
// depends on the camera that shows it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/four_joining.h"
#include "common/held_shape.h"
#include "common/morton.h"
#include "common/open_layers.h"
#include "common/plane_fit.h"

namespace framelet {

/// A layer of a framelet below a square, or what some of them were joined to.
struct JoinedLayer {
    static constexpr std::int16_t no_part = -1;

    // Not set where it is a framelet's and joined further.
    AffinePlane plane; ///< inverse depth, pixels from the square's corner
    double share = 0; ///< at most: of `difference` and the inverse depth there
    PlaneExtent extent; ///< of its samples
    PlaneSums sums;
    double difference = 0; ///< at most: of the plane from the layers that it was joined of, 1 / metres
    std::uint64_t newest_batch = 0;
    std::uint64_t signature = 0; ///< differs where what it was made of differs
    float error = 0; ///< largest of theirs
    std::uint32_t view = 0;
    Vec3 velocity{0};
    BodyNumber body = static_body;

    std::array<std::int16_t, 4> parts{no_part, no_part, no_part,
                                      no_part}; ///< what it was joined of: at most one of each quarter
    std::uint8_t levels = 0; ///< of the part below the square
    std::uint8_t part = 0; ///< in Morton order among those of its level
    std::uint8_t number = 0; ///< of the first layer that it was joined of
    bool is_joined_further = false;
};

/// Of a layer of a framelet among all those of a square.
constexpr std::uint8_t number_of(std::uint32_t part, std::uint32_t layer) {
    return static_cast<std::uint8_t>(part * max_layers + layer);
}

/// Joins layers below a square.
class LayerJoining {
public:
    static constexpr int most_levels = 3;
    static_assert(FourJoining::most_fours == std::size_t{1} << 2 * (most_levels - 1));
    /// Every one that is joined is of at least two, so that there are less of them than layers.
    static constexpr std::size_t most_layers = 2 * max_layers << 2 * most_levels;

    LayerJoining();

    /// `levels`: of framelets below the square.
    void start(int levels, SampleGrid const& grid);
    /// A layer of framelet `part` (in Morton order, in which they are added); some of its samples lie on it. What is
    /// held must stay until all is finished.
    void add(HeldLayer const& held, std::uint64_t batch, std::uint32_t view, std::uint32_t part, std::uint32_t layer);
    void finish();

    /// Layers first, in the order in which they were added.
    std::span<JoinedLayer const> layers() const { return std::span(layers_).first(layer_count_); }

private:
    struct FrameletLayer {
        HeldLayer const* held = nullptr;
        std::uint64_t batch = 0;
        std::uint32_t view = 0;
        std::uint8_t part = 0; ///< the framelet, in Morton order
        std::uint8_t layer = 0; ///< of the framelet's
        double motion = 0; ///< the same for all of one view, body and velocity
    };

    using Open = OpenLayers<(max_layers << 2 * most_levels)>; ///< in Morton order

    /// Of `open_`: those of one part, and where its quarters begin.
    struct Part {
        int levels = 0; ///< below the square
        std::array<std::size_t, 5> quarters{}; ///< one more at the end
    };

    using Members = std::array<std::int16_t, 4>;

    /// What of one part is about to be joined.
    struct Group {
        Members members{}; ///< of `open_`: one of each quarter or none
        AffinePlane plane;
        PlaneSums sums;
        PlaneExtent extent;
        double difference = 0;
        double share = 0;
        double joined_cost = 0;
        double cost_of_parts = 0;
    };

    JoinedLayer const& open_layer(std::size_t open) const {
        return layers_[static_cast<std::size_t>(open_->layer[open])];
    }
    double motion_of(FrameletLayer const& layer);
    void join_framelets();
    bool is_four(std::size_t first, std::size_t last) const;
    void keep_four(std::size_t first);
    void complete(std::size_t leaf);
    void join_part(std::size_t first, std::size_t last, int levels);
    void keep(Group const& group, std::size_t seed, int levels);
    Group group_of(std::size_t seed, Part const& part, bool cheaply) const;
    std::size_t join_first_ones(std::size_t seed, std::size_t quarter, Part const& part, Open::Bits const& candidates,
                                Group& group) const;
    Open::Bits candidates(Part const& part, std::size_t seed, AffinePlane const& plane) const;
    bool join(Members const& members, std::size_t seed, Group& group) const;
    std::uint32_t part_at(std::size_t open, int levels) const {
        return static_cast<std::uint32_t>(open_->part[open] >> 2 * (levels_ - levels));
    }

    int levels_ = 0;
    SampleGrid grid_;
    std::vector<FrameletLayer> leaves_;
    std::vector<std::int16_t> motions_; ///< the first leaf of each
    FourJoining fours_; ///< of the leaves
    std::vector<JoinedLayer> layers_; ///< room for all there can be
    std::size_t layer_count_ = 0;
    std::unique_ptr<Open> open_, next_; ///< at the level at hand, and one level up
};

} // namespace framelet
