// Keeps which tile a viewer got last at each place of its picture, what that showed and whether it was coded with loss,
// so that the same is not sent again, and what lacks nothing but exactness is. In: what is rendered and sent. Out:
// whether the viewer has it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet/framelet.h"

namespace framelet {

/// Hash of the colours of a framelet: equal ones mean equal pictures; never 0.
std::uint64_t content_of(DisplayFramelet const& framelet);

class HeldTiles {
public:
    explicit HeldTiles(ImagePlane const& plane = {});

    ImagePlane const& plane() const { return plane_; }
    /// Bytes of memory that it takes.
    static std::size_t bytes(Viewport viewport);

    /// Notes that the viewer gets this tile. `means`: its samples are means of several rays. `content`: as `content_of`
    /// has it, or 0 where the viewer will move what it shows away from here.
    void put(Tile tile, std::uint64_t content, bool means);
    /// True where the viewer shows nothing but this very tile, and it had this content, as means or else by single
    /// rays, whichever was put last.
    bool shows(Tile tile, std::uint64_t content, bool means) const;
    /// True where some of this tile shows means.
    bool shows_means(Tile tile) const;
    /// Notes that what the viewer holds is no longer where it was: it moves it all along with another camera.
    void forget_contents() { ++camera_; }

    void set_lossy(Tile tile, bool is_lossy);
    /// True where the viewer shows nothing but this very tile, with loss: once more without would be all that it lacks.
    bool is_lossy(Tile tile) const;
    bool any_lossy() const { return lossy_ > 0; }
    /// Replaces `tiles` by the finest tiles held with loss, at most so many.
    void list_lossy(std::size_t most, std::vector<Tile>& tiles) const;

private:
    /// A place: a square of the finest tile's side.
    struct Place {
        std::uint64_t content = 0, means = 0; ///< of the tile, by single rays and by several; 0: not known
        std::uint32_t camera = 0; ///< `camera_` when it came
        std::int8_t depth = -1; ///< of the tile; -1: none
        bool is_lossy = false;
    };

    /// True where `is` holds for all places of a tile that lie in the viewport.
    template <class Is>
    bool all_of(Tile tile, Is is) const;
    template <class Visit>
    void for_each(Tile tile, Visit visit);

    ImagePlane plane_;
    int columns_ = 0, rows_ = 0;
    std::vector<Place> places_; ///< row by row
    std::uint32_t camera_ = 0; ///< counts cameras
    std::size_t lossy_ = 0; ///< number of places held with loss
};

} // namespace framelet
