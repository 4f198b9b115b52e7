// The picture of a scene as it was a little while ago, between the content before that moment and the content after it
// ([Yang 2011]: bidirectional reprojection), where `Reprojector` alone can only go on from what is newest. In: what
// `Reprojector` takes, and every batch. Out: the picture, and which parts of it changed.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "common/held/framelet_pool.h"
#include "common/picture/mix_shares.h"
#include "common/picture/reprojector.h"

namespace framelet {

/// Moves what a cache of the newest framelets holds, and what a second cache holds that takes batches no sooner than
/// their scene time is shown, to the same camera and time, and mixes the two. Holds the second cache, two pictures, and
/// the batches between, at most a framelet for each 4x4 pixels of the viewport.
class SceneSmoother {
public:
    explicit SceneSmoother(ImagePlane plane);

    /// Takes what the cache that `show` is given has taken, or is about to take, with the same motions.
    void insert(Batch const& batch, BodyMotions const& motions);
    /// Does as `FrameletPool::settle` with what is held here, once all that came is shown.
    void settle();

    /// Shows a picture as `Reprojector::show` does; `newest` holds all that was inserted, and perhaps more. `lag`, at
    /// least 0, is how many seconds `scene_time` is behind the scene's clock: a change takes no longer, since what
    /// changes for the first time in long would else show as soon as it came. Where nothing that was inserted is later
    /// than `scene_time`, the picture is byte by byte what `Reprojector` shows, at the cost of one more copy; elsewhere
    /// it takes about twice as long. A clock that is set back ends what is going on.
    void show(FrameletPool const& newest, std::span<PixelRect const> changed, Camera const& camera,
              SceneTime scene_time, SceneTime lag, BodyMotions const& motions, Picture& picture,
              std::vector<PixelRect>& repainted);

    /// Makes the next `show` write its picture as a whole.
    void start_picture();

    /// `Reprojector::shown_blocks` of the pool that `show` was given.
    std::span<std::uint32_t const> shown_blocks() const { return newer_.reprojector.shown_blocks(); }

    /// Bytes of all that a viewer would not hold without this.
    std::size_t memory_bytes() const;

private:
    struct Side {
        Reprojector reprojector;
        Picture picture;
        ShownTimes base_times; ///< times of the base of the newest camera
        ShownTimes times; ///< times of all that the newest camera sees
        std::vector<PixelRect> repainted;

        MixSource source() const;
    };

    void take_due(SceneTime scene_time, BodyMotions const& motions);
    void update_times(FrameletPool const& pool, std::span<PixelRect const> changed, Side& shown) const;
    void mark(std::vector<PixelRect> const& rects, std::vector<std::uint8_t>& flags) const;
    void mix_block(std::size_t index, Picture& picture);
    PixelRect block_rect(std::size_t index) const;

    Viewport const viewport_;
    int const columns_;
    FrameletPool older_pool_;
    std::deque<Batch> waiting_; ///< batches that wait for their scene time to be shown, without tracks
    std::size_t waiting_framelets_ = 0;
    SceneTime shown_time_ = 0;
    Side older_, newer_;
    std::vector<PixelRect> changed_; ///< scratch: of the older cache
    std::vector<SentTile> evicted_; ///< scratch: nobody is told
    // These have an entry for each block of 16x16 pixels, in rows.
    std::vector<MixShare> shares_, shown_shares_;
    std::vector<std::uint8_t> dirty_; ///< one of the two pictures has changed there
    std::vector<std::uint8_t> equal_; ///< the two pictures are known to be equal there
    std::vector<std::uint8_t> painted_;
};

} // namespace framelet
