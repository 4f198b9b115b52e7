// The adaptive tiling of adaptive frameless rendering ([Dayal 2005]; [Stephens 2011] section 2.5): a kd-tree over
// the image whose leaves are all sampled equally often. The leaf of greatest error is split, the two siblings of least
// error are merged, so that the number of leaves stays. In: samples with their time. Out: where to sample.
#pragma once

#include <cstdint>
#include <vector>

#include "common/framelet/tile.h"

namespace framelet::bench {

class KdLeaves {
public:
    /// Makes about one leaf for every `pixels_a_leaf` pixels.
    KdLeaves(Viewport viewport, int pixels_a_leaf);

    std::size_t size() const { return leaves_.size(); }
    PixelRect const& rect(std::size_t leaf) const { return nodes_[leaves_[leaf]].rect; }

    /// Notes a sample of this luma in the leaf. Weights halve with every `half_life` seconds.
    void add(std::size_t leaf, double time, float luma);

    /// Splits the `count` leaves of greatest error and merges as many pairs of siblings of least error. Error is the
    /// age-weighted variance of a leaf's samples times its area. Leaf numbers change.
    void adapt(std::size_t count);

private:
    static constexpr double half_life = 0.25;
    static constexpr std::uint32_t none = ~0u;

    struct Node {
        PixelRect rect;
        std::uint32_t parent = none;
        std::uint32_t child = none; ///< the first of two that follow each other; none: a leaf
        double time = 0; ///< time at which the sums were brought up to date, seconds
        double weight = 0, sum = 0, squares = 0;
    };

    double error(Node const& node) const;
    void age(Node& node, double time) const;
    bool can_split(Node const& node) const { return node.rect.width() * node.rect.height() >= 8; }
    void split(std::uint32_t node);
    void merge(std::uint32_t parent);
    void collect_leaves();

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> free_; ///< first nodes of pairs that are not in use
    std::vector<std::uint32_t> leaves_;
    double now_ = 0;
};

} // namespace framelet::bench
