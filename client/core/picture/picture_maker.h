// The viewer's half of the pipeline after decoding: what the viewer holds, and the picture made of it, without sockets,
// threads or clocks. In: batches, and for each picture a camera and what the scene's clock says. Out: the picture.
#pragma once

#include <optional>
#include <vector>

#include "client/core/picture/late_clock.h"
#include "common/held/framelet_pool.h"
#include "common/image.h"
#include "common/picture/reprojector.h"
#include "common/picture/scene_smoother.h"

namespace framelet {

/// How pictures are made.
struct PictureSettings {
    bool reproject = true; ///< what is held is moved to where it is now; else it is shown where it was rendered
    bool scene_moves = true;
    double lag_seconds = 0; ///< > 0: the scene, not the camera, is shown so late, and between what is held
    // The evaluation leaves parts out, to see what each is worth; those of the first settings stay.
    std::size_t moments = FrameletPool::most_moments; ///< that are held
    bool knows_rest = true; ///< what rests is held as what stands
    ReprojectorParts parts{}; ///< of moving
    bool operator==(PictureSettings const&) const = default;
};

/// What a picture is to be of.
struct PictureRequest {
    Camera camera; ///< where `scene_camera` is -1
    std::uint64_t camera_number = 0; ///< its
    int scene_camera = -1; ///< >= 0: as that camera of the scene goes
    SceneTime present = 0; ///< what the scene's clock says
    double clock_speed = 1; ///< scene seconds a second
    double now = 0; ///< seconds of the viewer's own clock
    bool is_settled = false; ///< all that belongs to a complete picture of this has been inserted
};

/// A picture of which nothing is known.
Picture bare_picture(Viewport viewport);

/// What drawing over the picture shows.
enum class DrawnOver : std::uint8_t { nothing, outlines, confidence };

class PictureMaker {
public:
    PictureMaker(Viewport viewport, PictureSettings const& settings);

    Viewport viewport() const { return pool_.plane().viewport(); }
    /// The next picture is made as a whole where they differ from what they were.
    void set(PictureSettings const& settings);

    /// The batch must be of this viewport. What is not to be shown yet waits, unless something comes after it that is,
    /// or it gets too much.
    void insert(Batch const& batch);
    bool is_empty() const { return pool_.framelet_count() == 0; }
    FrameletPool const& pool() const { return pool_; }
    /// As of the pool: what the server should know.
    void take_evicted(std::vector<SentTile>& framelets) { pool_.take_evicted(framelets); }

    /// Brings `picture` up to date. True when it changed; `changed` gets the rectangles that may differ. A picture that
    /// is not the one of the last call, or has another size, is written as a whole. Nothing happens while nothing is
    /// held. With a canvas what is moved is painted there, unless the scene is smoothed: `is_on_canvas` says so. Throws
    /// what the canvas throws.
    bool show(PictureRequest const& request, Picture& picture, std::vector<PixelRect>& changed,
              BlockCanvas* canvas = nullptr);
    /// True when the last picture is not in memory but on the canvas.
    bool is_on_canvas() const { return settings_.reproject && !smoother_ && reprojector_.is_on_canvas(); }
    /// Draws over a copy of the picture that was shown last.
    void draw_over(DrawnOver what, Picture& picture) const;
    /// The point of the world that this place of it shows, as `find_shown_point`.
    std::optional<Vec3> point_at(Vec2 place) const;
    /// How deep its pixels are, as `find_shown_depths`.
    std::vector<float> depths() const;

    /// What the last picture shows; before there is one, what the newest batch was seen from.
    Camera const& shown_camera() const { return shown_camera_; }
    SceneTime shown_time() const { return shown_time_; }
    /// The number of that camera, where the viewer gave it.
    std::uint64_t shown_camera_number() const { return shown_camera_number_; }
    /// True when it was `reconstruct`'s as a whole: nothing in it was moved.
    bool is_exact() const { return !settings_.reproject || (!smoother_ && reprojector_.is_exact()); }
    /// Share of the picture that what is held shows; once moved, of the last picture. [0, 1].
    double coverage() const;
    bool is_smooth() const { return smoother_.has_value(); }
    std::size_t memory_bytes() const;

private:
    void start_smoothing();
    void take(Batch const& batch);
    void take_waiting(std::size_t count);
    void evict();
    void settle();
    SceneTime wanted_time(PictureRequest const& request);
    Camera wanted_camera(PictureRequest const& request, SceneTime time) const;

    PictureSettings settings_;
    FrameletPool pool_;
    BodyMotions motions_;
    std::vector<Batch> waiting_; ///< for their time to be shown, in the order in which they came
    std::size_t waiting_framelets_ = 0;
    BodyMotions cameras_; ///< tracks of the scene's, as `camera_body`
    Reprojector reprojector_;
    LateClock late_clock_{0};
    std::optional<SceneSmoother> smoother_;
    NumberedView batch_view_; ///< of the newest batch
    SceneTime batch_time_ = 0; ///< likewise
    Camera shown_camera_;
    std::uint64_t shown_camera_number_ = 0;
    SceneTime shown_time_ = 0;
    std::uint8_t const* shown_pixels_ = nullptr; ///< recognises the caller's picture
    std::vector<Tile> shown_tiles_; ///< scratch
    std::vector<PixelRect> arrived_; ///< scratch: where batches have changed something
};

} // namespace framelet
