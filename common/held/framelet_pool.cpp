#include "common/held/framelet_pool.h"

#include <algorithm>
#include <tuple>

#include "common/framelet/reprojection.h"

namespace framelet {

namespace {

/// True for what is held by moments; what drifts for a short time only is not.
bool moves(FrameletShape const& shape, SceneTime scene_time, BodyMotions const& motions) {
    return shape.moves() && !shape.is_brief && !is_at_rest(shape, scene_time, motions);
}

bool moves(Batch const& batch, BodyMotions const& motions) {
    return std::ranges::any_of(batch.shapes,
                               [&](FrameletShape const& shape) { return moves(shape, batch.scene_time, motions); });
}

/// Chunks for two pictures of a sample a pixel: about what a moment brings while things move, and what is evicted
/// meanwhile.
std::size_t chunks_of_two_pictures(ImagePlane const& plane) {
    Viewport const viewport = plane.viewport();
    auto const framelets =
        static_cast<std::size_t>(viewport.width) * static_cast<std::size_t>(viewport.height) / framelet_samples;
    return 2 * (framelets / std::tuple_size_v<FrameletRoom::Chunk> + 1);
}

} // namespace

FrameletPool::FrameletPool(ImagePlane plane, std::size_t most)
    : plane_(plane), most_(most), room_(std::make_unique<FrameletRoom>(chunks_of_two_pictures(plane))) {
    slots_.push_back({std::make_unique<FrameletCache>(plane, room_.get()), {}});
}

/// True when a batch is of another camera than the base, or the first one. Samples that cannot be moved share a cache
/// with those of any camera.
bool FrameletPool::begins_base(Batch const& batch) const {
    Slot const& slot = slots_[base_];
    return moments_ == 0 || (!(slot.camera == batch.view.camera) && is_reprojectable(batch.view.camera) &&
                             is_reprojectable(slot.camera));
}

bool FrameletPool::begins_moment(Batch const& batch, BodyMotions const& motions) const {
    return begins_base(batch) || (moving_slot(batch.scene_time) == slots_.size() &&
                                  is_reprojectable(batch.view.camera) && moves(batch, motions));
}

bool FrameletPool::has_moving() const {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        if (belongs_to_base(i) && slots_[i].cache->framelet_count() > 0) {
            return true;
        }
    }
    return false;
}

SlotRole FrameletPool::role(std::size_t slot) const {
    return {slot == base_ || slots_[slot].begun + recent_moments > moments_, slot == base_};
}

bool FrameletPool::is_tried(std::size_t slot) const {
    return slot != base_ && slots_[slot].begun + untried_moments <= moments_;
}

std::size_t FrameletPool::insert(Batch const& batch, BodyMotions const& motions, bool begins_moments) {
    if (moments_ == 0 || (begins_moments && begins_base(batch))) {
        base_ = begin_slot(batch);
    }
    Slot& base = slots_[base_];
    base.camera = batch.view.camera;
    bool const splits = begins_moments && base.scene_time != batch.scene_time && is_reprojectable(base.camera);
    return splits && moves(batch, motions) ? insert_moving(batch, motions) : base.cache->insert(batch);
}

/// Puts the framelets in which something moves into the slot of their time, the rest into the base.
std::size_t FrameletPool::insert_moving(Batch const& batch, BodyMotions const& motions) {
    stands_.clear();
    moves_.clear();
    for (FrameletShape const& shape : batch.shapes) {
        bool const is_moving = moves(shape, batch.scene_time, motions);
        moves_.push_back(is_moving ? 1 : 0);
        stands_.push_back(is_moving ? 0 : 1);
    }
    std::size_t slot = moving_slot(batch.scene_time);
    if (slot == slots_.size()) {
        slot = begin_slot(batch);
        if (moments_ == slots_[base_].begun + most_) {
            evict_moving(batch.scene_time, motions);
        }
    }
    return slots_[base_].cache->insert(batch, stands_) + slots_[slot].cache->insert(batch, moves_);
}

/// Evicts from the base what moves, since it is as old by now as what moved in other slots gets; what deforms goes
/// astray with time.
void FrameletPool::evict_moving(SceneTime now, BodyMotions const& motions) {
    FrameletCache& base = *slots_[base_].cache;
    std::vector<Tile> kept;
    for (std::size_t i = 0; i < base.slot_count(); ++i) {
        CachedFramelet const* const framelet = base.at_slot(i);
        if (framelet != nullptr &&
            (!framelet->shape.moves || framelet->shape.is_brief ||
             is_in_place(framelet->shape, base.views()[framelet->view].scene_time, now, motions))) {
            kept.push_back(framelet->tile);
        }
    }
    base.keep(kept, evicted_);
}

/// The slot that holds what moves in front of the newest camera at a scene time; `slot_count()` where there is none
/// yet.
std::size_t FrameletPool::moving_slot(SceneTime scene_time) const {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        if ((i == base_ || belongs_to_base(i)) && slots_[i].scene_time == scene_time) {
            return i;
        }
    }
    return slots_.size();
}

void FrameletPool::settle() {
    Slot& base = slots_[base_];
    std::uint64_t newest = base.begun;
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        if (!belongs_to_base(i)) {
            continue;
        }
        Slot& slot = slots_[i];
        base.cache->take(*slot.cache, evicted_);
        if (slot.begun > newest) {
            newest = slot.begun;
            base.scene_time = slot.scene_time;
        }
        slot.cache->clear();
        slot.begun = 0;
    }
    base.begun = newest;
}

/// The slot for a new moment: a free one, a new one, or that of which least shows, the oldest of those.
std::size_t FrameletPool::free_slot() {
    auto const free = std::ranges::find(slots_, 0u, &Slot::begun);
    if (free != slots_.end()) {
        return static_cast<std::size_t>(free - slots_.begin());
    }
    if (slots_.size() < most_) {
        slots_.push_back({std::make_unique<FrameletCache>(plane_, room_.get()), {}});
        return slots_.size() - 1;
    }
    auto const rank = [this](Slot const& slot) {
        auto const index = static_cast<std::size_t>(&slot - slots_.data());
        return std::tuple(index == base_, !is_tried(index), slot.shown, slot.begun);
    };
    auto const goes_first = [&](Slot const& a, Slot const& b) { return rank(a) < rank(b); };
    return static_cast<std::size_t>(std::ranges::min_element(slots_, goes_first) - slots_.begin());
}

std::size_t FrameletPool::begin_slot(Batch const& batch) {
    if (begins_base(batch)) {
        slots_[base_].begun = moments_; // what the last camera saw is as recent as what moved before it
    }
    std::size_t const index = free_slot();
    Slot& slot = slots_[index];
    slot.cache->add_held(evicted_);
    slot.cache->clear();
    slot.camera = batch.view.camera;
    slot.scene_time = batch.scene_time;
    slot.begun = ++moments_;
    slot.shown = 0;
    return index;
}

void FrameletPool::take_evicted(std::vector<SentTile>& framelets) {
    framelets.clear();
    framelets.swap(evicted_);
}

void FrameletPool::note_shown(std::span<std::uint32_t const> blocks) {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        slots_[i].shown = i < blocks.size() ? blocks[i] : 0;
    }
}

std::size_t FrameletPool::framelet_count() const {
    std::size_t count = 0;
    for (Slot const& slot : slots_) {
        count += slot.cache->framelet_count();
    }
    return count;
}

std::size_t FrameletPool::memory_bytes() const {
    std::size_t bytes = room_->memory_bytes();
    for (Slot const& slot : slots_) {
        bytes += slot.cache->memory_bytes();
    }
    return bytes;
}

} // namespace framelet
