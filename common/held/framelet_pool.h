// Holds the framelets of several moments, for a viewer that moves its samples. Each camera has a cache, its base, for
// what stands, rests or drifts briefly; what else moves in front of a standing camera has a cache for each scene time.
// What is held stays until something better has come, wherever it lies in the picture by then. In: batches in the order
// in which they were sent. Out: caches, from all of which a picture is made.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/framelet/body_motion.h"
#include "common/held/framelet_cache.h"

namespace framelet {

/// What the framelets of a slot are to the picture.
struct SlotRole {
    bool is_recent = true; ///< its outliers show
    bool is_base = true; ///< it is the newest camera's base, whose framelets newer ones replace in their places

    bool operator==(SlotRole const&) const = default;
};

/// A moment's framelets keep their slot as long as they are held. When the slots are used up, the moment of which the
/// last pictures showed least is evicted, but never the newest camera's base: what something covers for a while is
/// needed when that has gone by.
class FrameletPool {
public:
    /// Largest number of moments that are held: where things move there are up to ten a second, and a picture shows
    /// more than a second of them.
    static constexpr std::size_t most_moments = 16;
    /// Number of the newest moments, which have hardly been shown yet.
    static constexpr std::uint64_t untried_moments = 3;
    /// Number of the newest moments whose outliers show: those of more would cost much to paint and hardly show.
    static constexpr std::uint64_t recent_moments = 3;

    /// `most`: moments that are held, at least `untried_moments` and the base.
    explicit FrameletPool(ImagePlane plane, std::size_t most = most_moments);

    ImagePlane const& plane() const { return plane_; }

    /// Takes a batch as `FrameletCache::insert` does. `motions`: of bodies about the batch's scene time; what is at
    /// rest by them is held with what stands, where it replaces what shows the same. `begins_moments`: a moment begins
    /// where the camera is another than the last batch's, and where something moves in front of the same one. Where it
    /// is false, as for samples that are not to be moved, the newest of each tile are held, whatever their cameras and
    /// times.
    std::size_t insert(Batch const& batch, BodyMotions const& motions, bool begins_moments = true);

    /// True when `insert` would begin a moment.
    bool begins_moment(Batch const& batch, BodyMotions const& motions) const;

    /// Moves all that the newest camera saw to its base, since it is of one moment by now: the newest framelets of each
    /// tile are held there, as if all its batches had been inserted there.
    void settle();

    /// The caches by slot.
    std::size_t slot_count() const { return slots_.size(); }
    FrameletCache const& slot(std::size_t index) const { return *slots_[index].cache; }
    /// The base of the newest camera.
    std::size_t newest_slot() const { return base_; }
    FrameletCache const& newest() const { return slot(base_); }
    FrameletCache& newest() { return *slots_[base_].cache; }

    /// True for a slot of what the newest camera saw moving since its base began.
    bool belongs_to_base(std::size_t slot) const { return slots_[slot].begun > slots_[base_].begun; }
    /// True when anything is held in such slots.
    bool has_moving() const;
    /// Outliers show of the last `recent_moments` moments, and of the newest camera's base.
    SlotRole role(std::size_t slot) const;
    /// True when the slot's moment has been shown long enough to tell what of it is of no use. Never true of the base
    /// of the newest camera.
    bool is_tried(std::size_t slot) const;
    /// Evicts all framelets of a slot but those of `tiles`.
    void keep(std::size_t slot, std::span<Tile const> tiles) { slots_[slot].cache->keep(tiles, evicted_); }
    /// Replaces `framelets` by those that have been evicted since the last call, other than for newer ones in their
    /// places of the same moment.
    void take_evicted(std::vector<SentTile>& framelets);
    /// Takes, by slot, in how many blocks of the last picture something of it showed: what shows least is evicted next.
    void note_shown(std::span<std::uint32_t const> blocks);

    /// Number of framelets of all moments together.
    std::size_t framelet_count() const;
    std::size_t memory_bytes() const;

private:
    struct Slot {
        std::unique_ptr<FrameletCache> cache;
        Camera camera; ///< of its framelets
        SceneTime scene_time = 0; ///< of those of its framelets in which something moves
        std::uint64_t begun = 0; ///< counts moments; 0: free
        std::uint32_t shown = 0; ///< blocks of the last picture in which it showed
    };

    bool begins_base(Batch const& batch) const;
    std::size_t moving_slot(SceneTime scene_time) const;
    std::size_t free_slot();
    std::size_t begin_slot(Batch const& batch);
    std::size_t insert_moving(Batch const& batch, BodyMotions const& motions);
    void evict_moving(SceneTime now, BodyMotions const& motions);

    ImagePlane plane_;
    std::size_t most_;
    std::unique_ptr<FrameletRoom> room_; ///< shared by all caches
    std::vector<Slot> slots_;
    std::size_t base_ = 0;
    std::uint64_t moments_ = 0;
    std::vector<SentTile> evicted_;
    std::vector<std::uint8_t> stands_, moves_; ///< scratch: flags of a batch's framelets
};

} // namespace framelet
