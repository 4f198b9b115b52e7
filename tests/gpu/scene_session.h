// A session of a bundled scene on a virtual clock, without a link: it has what a viewer has been sent at a time. In: a
// scene file, a size. Out: batches.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/picture/reprojector.h"
#include "server/render/first_look.h"
#include "server/render/framelet_renderer.h"
#include "server/scene/motion/animation.h"
#include "server/scene/scene_import.h"
#include "server/stream/framelet_stream.h"
#include "server/stream/posed_scene.h"

namespace framelet {

class SceneSession {
public:
    using Camera = framelet::Camera;

    SceneSession(std::string const& name, Viewport viewport, double samples_per_second = 0)
        : scene_(import_scene(std::filesystem::path(FRAMELET_SOURCE_DIR "/scenes") / (name + ".glb"))),
          clips_(default_clips(scene_)), render_scene_(scene_, std::nullopt), posed_(scene_, clips_, render_scene_),
          viewport_(viewport),
          samples_per_second_(samples_per_second > 0 ? samples_per_second : 2.0 * viewport.width * viewport.height) {
        StreamOptions options;
        options.exposure = auto_exposure(render_scene_, camera_at(0));
        stream_.emplace(options, coding::all);
        stream_->take({0, ViewerSettings{0, 0, true}});
    }

    /// The scene's own camera at this time, or the default one.
    Camera camera_at(SceneTime time) {
        return scene_.cameras.empty() ? default_camera(scene_bounds(scene_, posed_.pose_of(0)))
                                      : posed_.camera(0, time);
    }

    /// Lets the server work until `now` while the viewer looks through the camera. `receive` gets each batch, and may
    /// answer with what the viewer evicts.
    void advance(double now, Camera const& camera, bool plays,
                 std::function<std::vector<SentTile>(Batch const&)> const& receive) {
        if (view_ == 0 || !(camera == camera_)) {
            camera_ = camera;
            stream_->take({now, CameraUpdate{{++view_, camera, viewport_, 1}, -1}});
        }
        scene_time_ = plays ? now : scene_time_;
        while (free_at_ <= now) {
            Step const step =
                stream_->plan({free_at_, scene_time_, plays ? 1.0 : 0.0, samples_per_second_, 1e-3}, posed_);
            if (step != Step::render) {
                free_at_ = now + 1e-6;
                return;
            }
            posed_.pose(stream_->moment());
            stream_->render(posed_);
            bool const sends = stream_->learn(posed_);
            free_at_ += std::max(static_cast<double>(stream_->learnt_figures().rays) / samples_per_second_, 1e-3);
            if (!sends) {
                continue;
            }
            Batch const& batch = stream_->learnt_batch();
            std::vector<SentTile> evicted = receive(batch);
            std::uint64_t const number = stream_->encode().number;
            stream_->take({free_at_, BatchSent{number, 1000}});
            if (!evicted.empty()) {
                stream_->take({free_at_, Evicted{std::move(evicted)}});
            }
            stream_->take({free_at_, Ack{number, static_cast<std::uint64_t>(1e6 * free_at_), 0}});
        }
    }

    SceneTime scene_time() const { return scene_time_; }
    bool is_complete() const { return stream_->is_complete(); }

private:
    Scene scene_;
    std::vector<Index> clips_;
    RenderScene render_scene_;
    PosedScene posed_;
    Viewport viewport_;
    double samples_per_second_;
    std::optional<FrameletStream> stream_;
    Camera camera_;
    std::uint64_t view_ = 0;
    double free_at_ = 0;
    SceneTime scene_time_ = 0;
};

/// Holds what a viewer holds, as `PictureMaker` does.
struct Holder {
    FrameletPool pool;
    BodyMotions motions;

    explicit Holder(Viewport viewport) : pool(ImagePlane(viewport)) {}

    /// Inserts a batch. `shown` tells what of a slot showed, as `Reprojector::add_shown`. Returns what is evicted.
    std::vector<SentTile> insert(Batch const& batch,
                                 std::function<bool(std::size_t, std::vector<Tile>&)> const& shown) {
        for (BodyTrack const& track : batch.tracks) {
            motions.extend(track);
        }
        if (batch.outdates) {
            motions.jump_at(batch.shown_from);
        }
        if (pool.begins_moment(batch, motions)) {
            for (std::size_t slot = 0; slot < pool.slot_count(); ++slot) {
                std::vector<Tile> tiles;
                if (pool.is_tried(slot) && shown(slot, tiles)) {
                    pool.keep(slot, tiles);
                }
            }
        }
        pool.insert(batch, motions);
        std::vector<SentTile> out;
        pool.take_evicted(out);
        return out;
    }
};

} // namespace framelet
