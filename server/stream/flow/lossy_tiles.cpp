#include "server/stream/flow/lossy_tiles.h"

#include <algorithm>

#include "common/error.h"

namespace framelet {

LossyTiles::Range LossyTiles::range_of(Tile tile) const {
    int const bits = 2 * (plane_.max_depth() - tile.depth());
    std::size_t const first = std::size_t{tile.index()} << bits;
    return {first, first + (std::size_t{1} << bits)};
}

void LossyTiles::sent(ImagePlane const& plane, Tile tile, std::uint8_t qp) {
    if (plane != plane_) {
        *this = {};
        plane_ = plane;
    }
    if (qp == lossless_qp && count_ == 0) {
        return;
    }
    depth_.resize(std::size_t{1} << (2 * plane_.max_depth()));
    auto const mark = static_cast<std::uint8_t>(qp == lossless_qp ? 0 : tile.depth() + 1);
    Range const range = range_of(tile);
    for (std::size_t i = range.first; i < range.last; ++i) {
        Tile const finest{static_cast<std::uint32_t>(depth_.size() + i)};
        if (depth_[i] != mark && plane_.is_visible(finest)) {
            count_ += depth_[i] == 0 ? 1 : 0;
            count_ -= mark == 0 ? 1 : 0;
            depth_[i] = mark;
        }
    }
}

bool LossyTiles::is_held(ImagePlane const& plane, Tile tile) const {
    if (count_ == 0 || plane != plane_) {
        return false;
    }
    Range const range = range_of(tile);
    for (std::size_t i = range.first; i < range.last; ++i) {
        Tile const finest{static_cast<std::uint32_t>(depth_.size() + i)};
        if (depth_[i] != tile.depth() + 1 && plane_.is_visible(finest)) {
            return false;
        }
    }
    return true;
}

void LossyTiles::list(std::size_t most, std::vector<Tile>& tiles) const {
    tiles.clear();
    for (std::size_t i = 0; i < depth_.size() && tiles.size() < std::min(most, count_); ++i) {
        if (depth_[i] != 0) {
            tiles.push_back({static_cast<std::uint32_t>(depth_.size() + i)});
        }
    }
}

void choose_qps(ImagePlane const& plane, std::span<Tile const> tiles, std::span<std::uint8_t> needed, std::uint8_t qp,
                bool finish, LossyTiles& lossy, std::vector<std::uint8_t>& qps) {
    FRAMELET_CHECK(tiles.size() == needed.size());
    qps.clear();
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        bool const again = needed[i] == 0 && lossy.is_held(plane, tiles[i]);
        needed[i] = needed[i] != 0 || again ? 1 : 0;
        if (needed[i] != 0) {
            bool const last = finish && tiles[i].depth() == plane.max_depth();
            qps.push_back(again || last ? lossless_qp : qp);
        }
    }
    // Where framelets of one batch overlap the finer ones show.
    for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
        std::size_t next = 0;
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            if (needed[i] != 0) {
                std::uint8_t const chosen = qps[next++];
                if (tiles[i].depth() == depth) {
                    lossy.sent(plane, tiles[i], chosen);
                }
            }
        }
    }
    if (std::ranges::all_of(qps, [](std::uint8_t q) { return q == lossless_qp; })) {
        qps.clear();
    }
}

} // namespace framelet
