// A scene loaded and ready to be rendered, as every verb of framelet-bench needs it.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "server/render/framelet_renderer.h"
#include "server/scene/animation.h"

namespace framelet::bench {

struct BenchScene {
    Scene scene;
    std::vector<Index> clips;
    std::unique_ptr<RenderScene> render_scene; ///< reads `scene`; posed at time 0
    Camera camera; ///< the scene's first, or the default one
    float exposure = 1;
};

/// Throws InputError.
std::unique_ptr<BenchScene> load_bench_scene(std::filesystem::path const& file);

} // namespace framelet::bench
