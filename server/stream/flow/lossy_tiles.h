// Keeps where a viewer holds samples that were coded with loss, so that they can be sent once more without. In: what
// was sent. Out: what is to be sent exactly. It keeps a byte for each of the finest tiles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet/framelet.h"

namespace framelet {

class LossyTiles {
public:
    /// Bytes of memory that it takes once something was sent with loss.
    static std::size_t bytes(ImagePlane const& plane) { return std::size_t{1} << (2 * plane.max_depth()); }

    /// Notes that the viewer gets this framelet, as its newest there. Another viewport forgets all.
    void sent(ImagePlane const& plane, Tile tile, std::uint8_t qp);
    bool empty() const { return count_ == 0; }
    /// True where the viewer shows nothing but this very tile, with loss: once more without would be all that it lacks.
    bool is_held(ImagePlane const& plane, Tile tile) const;
    /// Replaces `tiles` by the finest tiles held with loss, at most so many.
    void list(std::size_t most, std::vector<Tile>& tiles) const;

private:
    struct Range {
        std::size_t first = 0, last = 0;
    };
    Range range_of(Tile tile) const;

    ImagePlane plane_;
    std::vector<std::uint8_t> depth_; ///< of the lossy tile that a finest tile shows, plus 1; 0: none; by Morton index
    std::size_t count_ = 0; ///< visible ones that are not 0
};

/// Chooses which framelets of a batch go to the viewer and how they are coded. `needed`: what the scheduler says of
/// each; those that are not needed, because they have not changed, are added where the viewer holds them with loss.
/// `qp`: of the batch. `finish`: the picture stands still, and its finest tiles are the last that come: they are sent
/// exactly. Replaces `qps` by one for each framelet that is sent, in order, or by none where all are exact; keeps
/// account in `lossy`.
void choose_qps(ImagePlane const& plane, std::span<Tile const> tiles, std::span<std::uint8_t> needed, std::uint8_t qp,
                bool finish, LossyTiles& lossy, std::vector<std::uint8_t>& qps);

} // namespace framelet
