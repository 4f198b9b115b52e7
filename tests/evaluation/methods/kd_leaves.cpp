#include "tests/evaluation/methods/kd_leaves.h"

#include <algorithm>
#include <cmath>

namespace framelet::bench {

KdLeaves::KdLeaves(Viewport viewport, int pixels_a_leaf) {
    Node root;
    root.rect = {0, 0, viewport.width, viewport.height};
    nodes_.push_back(root);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (nodes_[i].rect.width() * nodes_[i].rect.height() >= 2 * pixels_a_leaf && can_split(nodes_[i])) {
            split(static_cast<std::uint32_t>(i));
        }
    }
    collect_leaves();
}

void KdLeaves::age(Node& node, double time) const {
    double const share = std::exp2((node.time - time) / half_life);
    node.weight *= share;
    node.sum *= share;
    node.squares *= share;
    node.time = time;
}

void KdLeaves::add(std::size_t leaf, double time, float luma) {
    Node& node = nodes_[leaves_[leaf]];
    age(node, time);
    now_ = time;
    node.weight += 1;
    node.sum += luma;
    node.squares += double(luma) * luma;
}

double KdLeaves::error(Node const& node) const {
    double const mean = node.weight > 0 ? node.sum / node.weight : 0;
    double const variance = node.weight > 0 ? std::max(0.0, node.squares / node.weight - mean * mean) : 0;
    return variance * node.rect.width() * node.rect.height();
}

void KdLeaves::split(std::uint32_t parent) {
    if (free_.empty()) {
        free_.push_back(static_cast<std::uint32_t>(nodes_.size()));
        nodes_.resize(nodes_.size() + 2);
    }
    std::uint32_t const child = free_.back();
    free_.pop_back();
    Node& node = nodes_[parent];
    node.child = child;
    Node half = node;
    half.parent = parent;
    half.child = none;
    half.weight /= 2;
    half.sum /= 2;
    half.squares /= 2;
    nodes_[child] = half;
    nodes_[child + 1] = half;
    PixelRect const& rect = node.rect;
    if (rect.width() >= rect.height()) {
        nodes_[child].rect.right = nodes_[child + 1].rect.left = (rect.left + rect.right) / 2;
    } else {
        nodes_[child].rect.bottom = nodes_[child + 1].rect.top = (rect.top + rect.bottom) / 2;
    }
}

void KdLeaves::merge(std::uint32_t parent) {
    Node& node = nodes_[parent];
    Node& a = nodes_[node.child];
    Node& b = nodes_[node.child + 1];
    age(a, now_);
    age(b, now_);
    node.time = now_;
    node.weight = a.weight + b.weight;
    node.sum = a.sum + b.sum;
    node.squares = a.squares + b.squares;
    free_.push_back(node.child);
    node.child = none;
}

void KdLeaves::adapt(std::size_t count) {
    using Ranked = std::pair<double, std::uint32_t>;
    std::vector<Ranked> worst, best;
    for (std::uint32_t const leaf : leaves_) {
        Node const& node = nodes_[leaf];
        if (can_split(node)) {
            worst.emplace_back(-error(node), leaf);
        }
        std::uint32_t const parent = node.parent;
        if (parent != none && nodes_[parent].child == leaf && nodes_[leaf + 1].child == none) {
            best.emplace_back(error(node) + error(nodes_[leaf + 1]), parent);
        }
    }
    count = std::min({count, worst.size(), best.size()});
    auto const rank = [count](std::vector<Ranked>& all) {
        std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end());
    };
    rank(worst);
    rank(best);
    for (std::size_t i = 0; i < count; ++i) {
        // Nothing is left to gain where the worst and the best meet; and a leaf just split is not merged again.
        std::uint32_t const parent = best[i].second;
        std::uint32_t const leaf = worst[i].second;
        if (best[i].first >= -worst[i].first || nodes_[leaf].parent == parent ||
            nodes_[nodes_[parent].child].child != none || nodes_[nodes_[parent].child + 1].child != none) {
            continue;
        }
        bool const already_merged = nodes_[nodes_[leaf].parent].child == none;
        if (!already_merged) {
            merge(parent);
            split(leaf);
        }
    }
    collect_leaves();
}

void KdLeaves::collect_leaves() {
    leaves_.clear();
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
        std::uint32_t const node = open.back();
        open.pop_back();
        if (nodes_[node].child == none) {
            leaves_.push_back(node);
        } else {
            open.push_back(nodes_[node].child + 1);
            open.push_back(nodes_[node].child);
        }
    }
}

} // namespace framelet::bench
