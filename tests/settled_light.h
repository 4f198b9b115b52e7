// A light cache that knows all that a camera sees. In: a scene, a camera. Out: the scene is rendered with that light.
#pragma once

#include "server/render/gathering/light_gathering.h"
#include "server/render/picture_renderer.h"
#include "server/render/prepared/prepared_scene.h"

namespace framelet::test {

/// Lights a scene by a cache as long as it lives.
class CachedLight {
public:
    CachedLight(RenderScene& scene, PathOptions const& options, float scene_size)
        : scene_(scene), light_(scene.prepared(), options), cache_(scene_size), gathering_(light_, cache_) {
        scene_.set_light(&cache_, options.sizes);
    }
    ~CachedLight() { scene_.set_light(nullptr, {}); }
    CachedLight(CachedLight const&) = delete;
    CachedLight& operator=(CachedLight const&) = delete;

    /// Gathers until all that the camera sees is good enough, or so many paths have been followed. Returns how many.
    std::size_t settle(Camera const& camera, Viewport viewport, std::size_t most_paths) {
        constexpr std::size_t slice = 8192;
        std::size_t all = 0;
        for (std::size_t seen = 1; seen > 0 && all < most_paths;) {
            render_radiance(scene_, camera, viewport, 1);
            for (seen = 0; all < most_paths;) {
                std::size_t const done = gathering_.work(slice);
                if (done == 0) {
                    break;
                }
                seen += done;
                all += done;
            }
        }
        return all;
    }

    /// To be called when the scene has another pose.
    void update() {
        light_.update();
        gathering_.note_pose();
    }

    LightCache& cache() { return cache_; }
    LightGathering& gathering() { return gathering_; }

private:
    RenderScene& scene_;
    PathLight light_;
    LightCache cache_;
    LightGathering gathering_;
};

} // namespace framelet::test
