#include "server/render/probe_renderer.h"

#include "server/render/prepared/prepared_scene.h"

namespace framelet {

std::uint64_t ProbeRenderer::render(RenderScene const& scene, Camera const& camera, Viewport viewport,
                                    DisplayTransform const& transform, std::span<Probe const> probes) {
    positions_.clear();
    spacings_.clear();
    for (Probe const& probe : probes) {
        positions_.push_back(probe.position);
        spacings_.push_back(probe.spacing);
    }
    radiance_.resize(probes.size());
    light_.resize(scene.prepared().light_cache != nullptr ? probes.size() : 0);
    std::uint64_t const rays =
        render_samples(scene, make_view_rays(camera, viewport), positions_, spacings_, radiance_, light_);
    luma_.clear();
    for (Vec3 const& light : radiance_) {
        luma_.push_back(display_luma(light, transform));
    }
    return rays;
}

} // namespace framelet
