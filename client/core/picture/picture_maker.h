// The viewer's half of the pipeline after decoding: what the viewer holds, and the picture made of it, without sockets,
// threads or clocks. In: batches, and for each picture a camera and what the scene's clock says. Out: the picture.
#pragma once

#include <optional>
#include <vector>

#include "client/core/drawn_over/drawn_over.h"
#include "client/core/drawn_over/refresh_rates.h"
#include "client/core/picture/late_clock.h"
#include "common/held/framelet_pool.h"
#include "common/image.h"
#include "common/picture/confidence.h"
#include "common/picture/reprojector.h"
#include "common/picture/scene_smoother.h"

namespace framelet {

/// Settings by which pictures are made.
struct PictureSettings {
    bool reproject = true; ///< what is held is moved to where it is now; else it is shown where it was rendered
    bool scene_moves = true;
    double lag_seconds = 0; ///< > 0: the scene, not the camera, is shown so late, interpolated
    // The evaluation leaves parts out, to see what each is worth. Later settings do not change `moments` and
    // `knows_rest`.
    std::size_t moments = FrameletPool::most_moments; ///< most that are held
    bool knows_rest = true; ///< bodies at rest are held with what stands
    ReprojectorParts parts{}; ///< steps of reprojection that are done
    bool operator==(PictureSettings const&) const = default;
};

/// The camera and time of a picture that is to be made.
struct PictureRequest {
    Camera camera; ///< used where `scene_camera` is -1
    std::uint64_t camera_number = 0; ///< number of `camera`
    int scene_camera = -1; ///< >= 0: seen through that camera of the scene
    SceneTime present = 0; ///< time of the scene's clock, seconds
    double clock_speed = 1; ///< scene seconds a second
    double now = 0; ///< seconds of the viewer's own clock
    bool is_settled = false; ///< all that belongs to a complete picture of this has been inserted
    DrawnOver drawn_over = DrawnOver::nothing; ///< that `PictureMaker::draw_over` is to draw over it
};

/// What a picture is of, and where it is. Before there is one, that of the newest batch.
struct ShownPicture {
    Camera camera;
    std::uint64_t camera_number = 0; ///< number of `camera`, where the viewer gave it; 0 before there is a picture
    SceneTime time = 0;
    bool is_on_canvas = false; ///< it is not in memory
};

/// The picture of a viewer that holds nothing.
Picture bare_picture(Viewport viewport);

class PictureMaker {
public:
    PictureMaker(Viewport viewport, PictureSettings const& settings);

    Viewport viewport() const { return pool_.plane().viewport(); }
    /// Changes the settings; the next picture is made as a whole where they differ from what they were.
    void set(PictureSettings const& settings);

    /// Inserts a batch, which must be of this viewport. One that is not to be shown yet waits, unless one comes after
    /// it that is, or too many wait.
    void insert(Batch const& batch);
    bool is_empty() const { return pool_.framelet_count() == 0; }
    FrameletPool const& pool() const { return pool_; }
    /// Replaces `framelets` by those evicted since the last call, as `FrameletPool::take_evicted`: the server should
    /// know of them.
    void take_evicted(std::vector<SentTile>& framelets) { pool_.take_evicted(framelets); }

    /// Brings `picture` up to date. True when it changed; `changed` gets the rectangles that may differ. A picture that
    /// lies elsewhere than that of the last call, or has another size, is written as a whole. Nothing happens while
    /// nothing is held. With a canvas what is moved is painted there, unless the scene is smoothed: `last_shown` says
    /// so. Throws what the canvas throws. Refreshes are counted while they are to be drawn.
    bool show(PictureRequest const& request, Picture& picture, std::vector<PixelRect>& changed,
              BlockCanvas* canvas = nullptr);
    /// Draws over a copy of the picture that was shown last what its request said.
    void draw_over(Picture& picture);
    /// True while what is drawn over changes as time goes by, be the picture as it was or not.
    bool drawn_over_fades() const { return rates_ && rates_->fades(); }
    /// The point of the world that the last picture shows at this position, as `find_shown_point`.
    std::optional<Vec3> point_at(Vec2 position) const;
    /// The depths of the last picture's pixels, as `find_shown_depths`.
    std::vector<float> depths() const;

    ShownPicture const& last_shown() const { return last_; }
    /// True when the last picture was made by `reconstruct` as a whole: nothing in it was moved.
    bool is_exact() const { return !settings_.reproject || (!smoother_ && reprojector_.is_exact()); }
    /// Share of the picture that is covered by what is held, [0, 1]; once samples are moved, that of the last picture.
    double coverage() const;
    bool is_smooth() const { return smoother_.has_value(); }
    std::size_t memory_bytes() const;

private:
    void start_smoothing();
    void take(Batch const& batch);
    void take_waiting(std::size_t count);
    void evict();
    void settle();
    void count_refreshes(DrawnOver what);
    SceneTime wanted_time(PictureRequest const& request);
    bool is_at_rest(PictureRequest const& request, SceneTime time) const;
    Camera wanted_camera(PictureRequest const& request, SceneTime time) const;

    PictureSettings settings_;
    FrameletPool pool_;
    BodyMotions motions_;
    /// Batches whose time to be shown has not come, in the order in which they came, without their tracks.
    std::vector<Batch> waiting_;
    std::size_t waiting_bytes_ = 0; ///< of these
    BodyMotions cameras_; ///< tracks of the scene's cameras, numbered as `camera_body`
    Reprojector reprojector_;
    LateClock late_clock_{0};
    std::optional<SceneSmoother> smoother_;
    NumberedView batch_view_; ///< of the newest batch
    SceneTime batch_time_ = 0; ///< of the newest batch
    ShownPicture last_;
    std::uint8_t const* shown_pixels_ = nullptr; ///< recognises the caller's picture
    std::vector<Tile> shown_tiles_; ///< scratch
    std::vector<PixelRect> arrived_; ///< scratch: where batches have changed something
    DrawnOver drawn_over_ = DrawnOver::nothing;
    std::optional<RefreshRates> rates_;
    std::vector<PixelConfidence> confidence_; ///< scratch
};

} // namespace framelet
