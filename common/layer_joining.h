// Which layers of neighbouring framelets are about one plane: joined from the bottom up in the quadtree of a square,
// first within four framelets, then within four of those. In: layers and where they lie. Out: the planes of what is
// joined, as a forest, so that a picture for which a plane is too rough shows those that it was joined of. None of this
// depends on the camera that shows it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/held_shape.h"
#include "common/plane_fit.h"

namespace framelet {

/// Inverse depths that differ by less than this share are the same for all that looks at them.
inline constexpr double one_surface = 2e-3;

/// Of a square's samples in one grid: columns and rows, last ones included.
struct SampleBox {
    int first_column = 0, first_row = 0, last_column = -1, last_row = -1;
};

/// A layer of a framelet, or what some of them were joined to.
struct JoinedLayer {
    static constexpr std::int16_t no_part = -1;

    AffinePlane plane; ///< inverse depth, pixels from the square's corner
    PlaneSums sums;
    PlaneExtent extent; ///< of its samples
    SampleBox box;
    double difference = 0; ///< at most: of the plane from the layers that it was joined of, 1 / metres
    double share = 0; ///< at most: of that and the inverse depth there
    double error = 0; ///< largest of theirs
    std::uint32_t view = 0;
    BodyNumber body = static_body;
    Vec3 velocity{0};
    std::uint64_t newest_batch = 0;
    std::uint64_t signature = 0; ///< differs where what it was made of differs
    int levels = 0; ///< of the part below the square
    std::uint8_t number = 0; ///< of the first layer that it was joined of
    std::uint32_t part = 0; ///< in Morton order among those of its level
    std::array<std::int16_t, 4> parts{no_part, no_part, no_part,
                                      no_part}; ///< what it was joined of: at most one of each quarter
    bool is_joined_further = false;
};

/// Joins layers below a square.
class LayerJoining {
public:
    static constexpr int most_levels = 3;
    /// Every one that is joined is of at least two, so that there are less of them than layers.
    static constexpr std::size_t most_layers = 2 * max_layers << 2 * most_levels;

    /// `levels`: of framelets below the square.
    void start(int levels);
    /// In Morton order of their `part`s.
    void add(JoinedLayer const& layer);
    void finish();

    /// Layers first, in the order in which they were added.
    std::vector<JoinedLayer> const& layers() const { return layers_; }

private:
    struct Group {
        JoinedLayer layer;
        int count = 0; ///< of its parts
        double joined_cost = 0;
        double cost_of_parts = 0;
    };

    void join_part(std::size_t first, std::size_t last, int levels);
    Group group_of(std::size_t first, std::size_t last, int levels, bool cheaply) const;
    bool join_first_ones(std::size_t first, std::size_t last, int levels, Group& group) const;
    bool join(std::array<std::int16_t, 4> const& parts, Group& group) const;

    int levels_ = 0;
    std::vector<JoinedLayer> layers_;
    std::vector<std::int16_t> open_, next_; ///< those that may be joined further, in Morton order
};

} // namespace framelet
