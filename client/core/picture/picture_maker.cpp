#include "client/core/picture/picture_maker.h"

#include <algorithm>
#include <cmath>

#include "client/core/camera/camera_track.h"
#include "client/core/drawn_over/confidence_colors.h"
#include "client/core/drawn_over/framelet_outlines.h"
#include "client/core/drawn_over/holes.h"
#include "common/framelet/waiting_batch.h"
#include "common/picture/reconstruction.h"
#include "common/picture/shown_point.h"

namespace framelet {

Picture bare_picture(Viewport viewport) {
    Picture out(viewport.width, viewport.height);
    reconstruct_all(FrameletCache{ImagePlane(viewport)}, out);
    return out;
}

PictureMaker::PictureMaker(Viewport viewport, PictureSettings const& settings)
    : settings_(settings), pool_(ImagePlane(viewport), settings.moments), motions_(settings.knows_rest),
      reprojector_(settings.parts) {
    start_smoothing();
}

void PictureMaker::set(PictureSettings const& settings) {
    if (!(settings_ == settings)) {
        settings_ = settings;
        start_smoothing();
    }
}

/// Begins to smooth the scene anew where the settings ask for it.
void PictureMaker::start_smoothing() {
    smoother_.reset();
    late_clock_ = LateClock(settings_.lag_seconds);
    shown_pixels_ = nullptr; // the next picture is made as a whole
    if (settings_.lag_seconds > 0 && settings_.reproject && settings_.scene_moves) {
        smoother_.emplace(pool_.plane());
    }
}

void PictureMaker::insert(Batch const& batch) {
    if (rates_) {
        rates_->add(batch);
    }
    for (BodyTrack const& track : batch.tracks) {
        motions_.extend(track);
    }
    if (batch.camera_track) {
        cameras_.extend(*batch.camera_track);
    }
    if (batch.outdates) {
        motions_.jump_at(batch.shown_from);
    }
    if (shown_pixels_ == nullptr || !settings_.reproject || batch.shown_from <= last_.time) {
        take_waiting(waiting_.size());
        take(batch);
        return;
    }
    waiting_bytes_ += bytes_of(waiting_.emplace_back(without_tracks(batch)));
    constexpr std::size_t most_samples = 24; // samples a pixel: a moment has no more in all its levels together
    constexpr std::size_t framelet_bytes = sizeof(DisplayFramelet) + sizeof(FrameletShape);
    auto const pixels = static_cast<std::size_t>(viewport().width) * static_cast<std::size_t>(viewport().height);
    if (waiting_bytes_ > most_samples * pixels / framelet_samples * framelet_bytes) {
        take_waiting(waiting_.size());
    }
}

/// Takes the first `count` of the batches that wait.
void PictureMaker::take_waiting(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        take(waiting_[i]);
        waiting_bytes_ -= bytes_of(waiting_[i]);
    }
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
}

void PictureMaker::take(Batch const& batch) {
    if (shown_pixels_ == nullptr) {
        last_.camera = batch.view.camera;
        last_.time = batch.scene_time;
    }
    batch_view_ = batch.view;
    batch_time_ = batch.scene_time;
    if (settings_.reproject && pool_.begins_moment(batch, motions_)) {
        evict();
    }
    pool_.insert(batch, motions_, settings_.reproject);
    if (smoother_) {
        smoother_->insert(batch, motions_);
    }
}

/// Evicts the framelets of older moments of which nothing shows: they would take room, and time to paint.
void PictureMaker::evict() {
    for (std::size_t slot = 0; slot < pool_.slot_count(); ++slot) {
        shown_tiles_.clear();
        if (pool_.is_tried(slot) && !smoother_ && reprojector_.add_shown(slot, shown_tiles_)) {
            pool_.keep(slot, shown_tiles_);
        }
    }
}

void PictureMaker::settle() {
    pool_.settle();
    if (smoother_) {
        smoother_->settle();
    }
}

/// The scene time to show: the present or, where the scene is smoothed, what was the present a lag ago.
SceneTime PictureMaker::wanted_time(PictureRequest const& request) {
    SceneTime const time = settings_.scene_moves ? request.present : 0;
    return smoother_ ? late_clock_.read(request.now, time) : time;
}

/// A camera of the scene is where the newest batch of this very time saw it. Between the keys of its track it is only
/// nearly there, and what is held would never be in its place, not even at rest.
Camera PictureMaker::wanted_camera(PictureRequest const& request, SceneTime time) const {
    if (request.scene_camera < 0) {
        return request.camera;
    }
    BodyTrack const* const track = cameras_.find(camera_body(request.scene_camera));
    Camera const& newest = batch_view_.camera;
    bool const is_seen = batch_time_ == time && batch_view_.number == request.camera_number;
    return track == nullptr || is_seen ? newest : camera_at(*track, time, newest);
}

/// Begins or ends to count refreshes where something else is to be drawn over the picture.
void PictureMaker::count_refreshes(DrawnOver what) {
    if (what == drawn_over_) {
        return;
    }
    drawn_over_ = what;
    rates_.reset();
    if (what == DrawnOver::refresh_rate) {
        rates_.emplace(pool_.plane());
    }
}

/// True where the newest batch is of the very camera and time that were shown last and are to be shown again: all that
/// comes from now on is of them.
bool PictureMaker::is_at_rest(PictureRequest const& request, SceneTime time) const {
    return shown_pixels_ != nullptr && last_.time == time && batch_time_ == time &&
           last_.camera == batch_view_.camera && wanted_camera(request, time) == batch_view_.camera;
}

bool PictureMaker::show(PictureRequest const& request, Picture& picture, std::vector<PixelRect>& changed,
                        BlockCanvas* canvas) {
    changed.clear();
    count_refreshes(request.drawn_over);
    if (rates_) {
        rates_->advance(request.now);
    }
    if (is_empty()) {
        return false;
    }
    SceneTime const time = wanted_time(request);
    bool const shows_all = request.is_settled || !settings_.reproject;
    auto const waits = [&](Batch const& batch) { return !shows_all && batch.shown_from > time; };
    take_waiting(static_cast<std::size_t>(std::ranges::find_if(waiting_, waits) - waiting_.begin()));
    if (shows_all || is_at_rest(request, time)) {
        settle();
    }
    Viewport const size = viewport();
    bool const whole =
        picture.rgba.data() != shown_pixels_ || picture.width != size.width || picture.height != size.height;
    pool_.newest().take_changed(changed);
    if (whole) {
        if (picture.width != size.width || picture.height != size.height) {
            picture = Picture(size.width, size.height);
        }
        reprojector_ = Reprojector(settings_.parts);
        if (smoother_) {
            smoother_->start_picture();
        }
        changed.assign(1, {0, 0, size.width, size.height});
        shown_pixels_ = picture.rgba.data();
    }
    if (!settings_.reproject) {
        last_ = {batch_view_.camera, batch_view_.number, batch_time_};
        reconstruct(pool_.newest(), changed, picture);
        return !changed.empty();
    }
    last_ = {wanted_camera(request, time), request.camera_number, time};
    arrived_.swap(changed);
    if (smoother_) {
        SceneTime const lag = settings_.lag_seconds * std::abs(request.clock_speed);
        smoother_->show(pool_, arrived_, last_.camera, time, lag, motions_, picture, changed);
        pool_.note_shown(smoother_->shown_blocks());
    } else {
        reprojector_.show(pool_, arrived_, last_.camera, time, motions_, picture, changed, canvas);
        last_.is_on_canvas = reprojector_.is_on_canvas();
        pool_.note_shown(reprojector_.shown_blocks());
    }
    return !changed.empty();
}

void PictureMaker::draw_over(Picture& picture) {
    if (is_empty() || viewport() != Viewport{picture.width, picture.height}) {
        return;
    }
    switch (drawn_over_) {
    case DrawnOver::nothing:
        break;
    case DrawnOver::ages:
        draw_outlines(pool_.newest(), picture);
        break;
    case DrawnOver::confidence:
        if (!settings_.reproject) { // the times of its pixels are those of its framelets
            draw_outlines(pool_.newest(), picture);
            break;
        }
        find_confidence(pool_, last_.camera, last_.time, motions_, confidence_);
        draw_confidence(confidence_, picture);
        break;
    case DrawnOver::refresh_rate:
        rates_->draw(picture);
        break;
    case DrawnOver::arrivals:
        draw_arrivals(pool_, picture);
        break;
    case DrawnOver::holes:
        if (!settings_.reproject) {
            draw_holes(pool_.newest(), picture);
            break;
        }
        find_confidence(pool_, last_.camera, last_.time, motions_, confidence_);
        draw_holes(confidence_, picture);
        break;
    }
}

std::optional<Vec3> PictureMaker::point_at(Vec2 position) const {
    return find_shown_point(pool_, last_.camera, last_.time, motions_, position);
}

std::vector<float> PictureMaker::depths() const {
    return find_shown_depths(pool_, last_.camera, last_.time, motions_);
}

double PictureMaker::coverage() const {
    bool const moves = settings_.reproject && shown_pixels_ != nullptr && !smoother_ && !reprojector_.is_exact();
    return moves ? 1 - reprojector_.hole_share() : pool_.newest().coverage();
}

std::size_t PictureMaker::memory_bytes() const {
    return pool_.memory_bytes() + (smoother_ ? smoother_->memory_bytes() : 0) + waiting_bytes_;
}

} // namespace framelet
