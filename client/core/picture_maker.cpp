#include "client/core/picture_maker.h"

#include <cmath>

#include "client/core/camera_track.h"
#include "client/core/confidence_colors.h"
#include "client/core/framelet_outlines.h"
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

/// Where the scene is to be smoothed, from here on.
void PictureMaker::start_smoothing() {
    smoother_.reset();
    late_clock_ = LateClock(settings_.lag_seconds);
    shown_pixels_ = nullptr; // all of it anew
    if (settings_.lag_seconds > 0 && settings_.reproject && settings_.scene_moves) {
        smoother_.emplace(pool_.plane());
    }
}

void PictureMaker::insert(Batch const& batch) {
    if (shown_pixels_ == nullptr) {
        shown_camera_ = batch.view.camera;
        shown_time_ = batch.scene_time;
    }
    batch_view_ = batch.view;
    batch_time_ = batch.scene_time;
    for (BodyTrack const& track : batch.tracks) {
        motions_.extend(track);
    }
    if (settings_.reproject && pool_.begins_moment(batch, motions_)) {
        let_go();
    }
    pool_.insert(batch, motions_, settings_.reproject);
    if (smoother_) {
        smoother_->insert(batch, motions_);
    }
    if (batch.camera_track) {
        cameras_.extend(*batch.camera_track);
    }
}

/// What of older moments shows nowhere makes room, and no longer costs time.
void PictureMaker::let_go() {
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

/// The camera of the request and the present, or what is late by the lag.
std::pair<Camera, SceneTime> PictureMaker::wanted(PictureRequest const& request) {
    SceneTime time = settings_.scene_moves ? request.present : 0;
    if (smoother_) {
        time = late_clock_.read(request.now, time);
    }
    if (request.scene_camera < 0) {
        return {request.camera, time};
    }
    BodyTrack const* const track = cameras_.find(camera_body(request.scene_camera));
    Camera const& newest = batch_view_.camera;
    return {track == nullptr ? newest : camera_at(*track, time, newest), time};
}

bool PictureMaker::show(PictureRequest const& request, Picture& picture, std::vector<PixelRect>& changed) {
    changed.clear();
    if (is_empty()) {
        return false;
    }
    if (request.is_settled || !settings_.reproject) {
        settle();
    }
    Viewport const size = viewport();
    bool const whole =
        picture.rgba.data() != shown_pixels_ || picture.width != size.width || picture.height != size.height;
    pool_.newest().take_changed(changed);
    if (whole) {
        picture = Picture(size.width, size.height);
        reprojector_ = Reprojector(settings_.parts);
        if (smoother_) {
            smoother_->start_picture();
        }
        changed.assign(1, {0, 0, size.width, size.height});
        shown_pixels_ = picture.rgba.data();
    }
    if (!settings_.reproject) {
        shown_camera_ = batch_view_.camera;
        shown_camera_number_ = batch_view_.number;
        shown_time_ = batch_time_;
        reconstruct(pool_.newest(), changed, picture);
        return !changed.empty();
    }
    auto const [camera, time] = wanted(request);
    shown_camera_ = camera;
    shown_camera_number_ = request.camera_number;
    shown_time_ = time;
    arrived_.swap(changed);
    if (smoother_) {
        SceneTime const lag = settings_.lag_seconds * std::abs(request.clock_speed);
        smoother_->show(pool_, arrived_, camera, time, lag, motions_, picture, changed);
        pool_.note_shown(smoother_->shown_blocks());
    } else {
        reprojector_.show(pool_, arrived_, camera, time, motions_, picture, changed);
        pool_.note_shown(reprojector_.shown_blocks());
    }
    return !changed.empty();
}

void PictureMaker::draw_over(DrawnOver what, Picture& picture) const {
    if (what == DrawnOver::nothing || is_empty() || viewport() != Viewport{picture.width, picture.height}) {
        return;
    }
    if (what == DrawnOver::outlines || !settings_.reproject) {
        draw_outlines(pool_.newest(), picture);
        return;
    }
    std::vector<PixelConfidence> confidence;
    find_confidence(pool_, shown_camera_, shown_time_, motions_, confidence);
    draw_confidence(confidence, picture);
}

std::optional<Vec3> PictureMaker::point_at(Vec2 place) const {
    return find_shown_point(pool_, shown_camera_, shown_time_, motions_, place);
}

double PictureMaker::coverage() const {
    bool const moves = settings_.reproject && shown_pixels_ != nullptr && !smoother_ && !reprojector_.is_exact();
    return moves ? 1 - reprojector_.hole_share() : pool_.newest().coverage();
}

std::size_t PictureMaker::memory_bytes() const {
    return pool_.memory_bytes() + (smoother_ ? smoother_->memory_bytes() : 0);
}

} // namespace framelet
