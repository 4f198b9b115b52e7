#include "common/picture/framelet_pool.h"

#include <algorithm>
#include <tuple>

#include "common/reprojection.h"

namespace framelet {

FrameletPool::FrameletPool(ImagePlane plane) : plane_(plane) {
    slots_.push_back({std::make_unique<FrameletCache>(plane), {}});
}

/// Samples that cannot be moved share a cache with those of any camera.
bool FrameletPool::begins_moment(Batch const& batch) const {
    Slot const& slot = slots_[newest_];
    return moments_ == 0 || (!(slot.camera == batch.view.camera) && is_reprojectable(batch.view.camera) &&
                             is_reprojectable(slot.camera));
}

bool FrameletPool::is_recent(std::size_t slot) const {
    return slots_[slot].begun + recent_moments > moments_;
}

bool FrameletPool::is_tried(std::size_t slot) const {
    return slots_[slot].begun + untried_moments <= moments_;
}

std::size_t FrameletPool::insert(Batch const& batch, bool begins_moments) {
    if (moments_ == 0 || (begins_moments && begins_moment(batch))) {
        begin_moment(batch.view.camera);
    }
    slots_[newest_].camera = batch.view.camera;
    return slots_[newest_].cache->insert(batch);
}

/// A new one, or that of which least shows, the oldest of those.
std::size_t FrameletPool::free_slot() {
    if (moments_ == 0) {
        return 0;
    }
    if (slots_.size() < most_moments) {
        slots_.push_back({std::make_unique<FrameletCache>(plane_), {}});
        return slots_.size() - 1;
    }
    auto const is_untried = [this](Slot const& slot) {
        return !is_tried(static_cast<std::size_t>(&slot - slots_.data()));
    };
    auto const goes_first = [&](Slot const& a, Slot const& b) {
        return std::tuple(is_untried(a), a.shown, a.begun) < std::tuple(is_untried(b), b.shown, b.begun);
    };
    return static_cast<std::size_t>(std::ranges::min_element(slots_, goes_first) - slots_.begin());
}

void FrameletPool::begin_moment(Camera const& camera) {
    newest_ = free_slot();
    Slot& slot = slots_[newest_];
    slot.cache->add_held(let_go_);
    slot.cache->clear();
    slot.begun = ++moments_;
    slot.shown = 0;
    slot.camera = camera;
}

void FrameletPool::take_let_go(std::vector<SentTile>& framelets) {
    framelets.clear();
    framelets.swap(let_go_);
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
    std::size_t bytes = 0;
    for (Slot const& slot : slots_) {
        bytes += slot.cache->memory_bytes();
    }
    return bytes;
}

} // namespace framelet
