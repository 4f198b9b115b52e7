#include "common/picture/scene_smoother.h"

#include <algorithm>
#include <utility>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "common/framelet/waiting_batch.h"
#include "common/held/block_flags.h"

namespace framelet {

namespace {

constexpr int side = FrameletCache::block_side;

/// A clock that goes back by more than this many seconds has been set back; by less, it has been corrected.
constexpr SceneTime correction_seconds = 0.1;

int blocks_of(int pixels) {
    return (pixels + side - 1) / side;
}

/// Largest number of framelets that wait: as many as a cache holds at most.
std::size_t most_waiting(Viewport viewport) {
    constexpr int finest = side >> finest_levels;
    return static_cast<std::size_t>((viewport.width + finest - 1) / finest) *
           static_cast<std::size_t>((viewport.height + finest - 1) / finest);
}

} // namespace

MixSource SceneSmoother::Side::source() const {
    return {picture, reprojector.is_exact() ? std::span<float const>{} : reprojector.inverse_depth()};
}

SceneSmoother::SceneSmoother(ImagePlane plane)
    : viewport_(plane.viewport()), columns_(blocks_of(viewport_.width)), older_pool_(plane) {
    std::size_t const blocks =
        static_cast<std::size_t>(columns_) * static_cast<std::size_t>(blocks_of(viewport_.height));
    older_.picture = newer_.picture = Picture(viewport_.width, viewport_.height);
    dirty_.resize(blocks);
    equal_.resize(blocks);
    painted_.resize(blocks);
    start_picture();
}

void SceneSmoother::start_picture() {
    shares_.assign(dirty_.size(), whole_share);
    shown_shares_.assign(dirty_.size(), -1); // no share: every block is to be written
    std::ranges::fill(equal_, std::uint8_t{0});
}

void SceneSmoother::insert(Batch const& batch, BodyMotions const& motions) {
    if (batch.framelets.empty()) {
        return;
    }
    waiting_framelets_ += batch.framelets.size();
    waiting_.push_back(without_tracks(batch));
    while (waiting_framelets_ > most_waiting(viewport_)) {
        waiting_framelets_ -= waiting_.front().framelets.size();
        older_pool_.insert(waiting_.front(), motions);
        waiting_.pop_front();
    }
}

void SceneSmoother::take_due(SceneTime scene_time, BodyMotions const& motions) {
    bool const set_back = scene_time < shown_time_ - correction_seconds;
    shown_time_ = scene_time;
    std::erase_if(waiting_, [&](Batch const& batch) {
        if (batch.scene_time > scene_time && !set_back) {
            return false;
        }
        waiting_framelets_ -= batch.framelets.size();
        older_pool_.insert(batch, motions);
        return true;
    });
    older_pool_.take_evicted(evicted_);
}

void SceneSmoother::settle() {
    if (waiting_.empty()) {
        older_pool_.settle();
    }
}

/// Brings the times of a side up to date. `changed`: rectangles of the base.
void SceneSmoother::update_times(FrameletPool const& pool, std::span<PixelRect const> changed, Side& shown) const {
    update_shown_times(pool.newest(), changed, shown.base_times);
    shown.times = shown.base_times;
    for (std::size_t i = 0; i < pool.slot_count(); ++i) {
        if (pool.belongs_to_base(i)) {
            add_later_times(pool.slot(i), shown.times);
        }
    }
}

void SceneSmoother::mark(std::vector<PixelRect> const& rects, std::vector<std::uint8_t>& flags) const {
    for (PixelRect const& rect : rects) {
        for (int row = rect.top / side; row * side < rect.bottom; ++row) {
            auto const first = flags.begin() + static_cast<std::ptrdiff_t>(row) * columns_;
            std::fill(first + rect.left / side, first + blocks_of(rect.right), std::uint8_t{1});
        }
    }
}

PixelRect SceneSmoother::block_rect(std::size_t index) const {
    int const left = side * static_cast<int>(index % static_cast<std::size_t>(columns_));
    int const top = side * static_cast<int>(index / static_cast<std::size_t>(columns_));
    return {left, top, std::min(left + side, viewport_.width), std::min(top + side, viewport_.height)};
}

void SceneSmoother::mix_block(std::size_t index, Picture& picture) {
    MixShare const share = shares_[index];
    MixShare const before = std::exchange(shown_shares_[index], share);
    bool const dirty = std::exchange(dirty_[index], std::uint8_t{0}) != 0;
    if (dirty) {
        equal_[index] = 0;
    }
    if (!dirty && (share == before || equal_[index] != 0)) {
        return;
    }
    PixelRect const rect = block_rect(index);
    if (share == whole_share) {
        copy_pixels(newer_.picture, rect, picture);
    } else {
        equal_[index] = mix_pictures(older_.source(), newer_.source(), share, rect, picture) ? 0 : 1;
    }
    painted_[index] = 1;
}

void SceneSmoother::show(FrameletPool const& newest, std::span<PixelRect const> changed, Camera const& camera,
                         SceneTime scene_time, SceneTime lag, BodyMotions const& motions, Picture& picture,
                         std::vector<PixelRect>& repainted) {
    FRAMELET_CHECK(newest.plane().viewport() == viewport_);
    FRAMELET_CHECK(picture.width == viewport_.width && picture.height == viewport_.height);
    take_due(scene_time, motions);
    newer_.reprojector.show(newest, changed, camera, scene_time, motions, newer_.picture, newer_.repainted);
    mark(newer_.repainted, dirty_);
    update_times(newest, changed, newer_);
    if (waiting_.empty()) { // the two caches show the same
        std::ranges::fill(shares_, whole_share);
    } else {
        older_pool_.newest().take_changed(changed_);
        older_.reprojector.show(older_pool_, changed_, camera, scene_time, motions, older_.picture, older_.repainted);
        older_pool_.note_shown(older_.reprojector.shown_blocks());
        mark(older_.repainted, dirty_);
        update_times(older_pool_, changed_, older_);
        mix_shares(older_.times, newer_.times, columns_, scene_time, lag, shares_);
    }
    tbb::parallel_for(std::size_t{0}, shares_.size(), [&](std::size_t index) { mix_block(index, picture); });
    take_flagged(painted_, columns_, viewport_, repainted);
}

std::size_t SceneSmoother::memory_bytes() const {
    return older_pool_.memory_bytes() + waiting_framelets_ * (sizeof(DisplayFramelet) + sizeof(FrameletShape)) +
           older_.picture.rgba.capacity() + newer_.picture.rgba.capacity();
}

} // namespace framelet
