// Renders probes again. In: probes. Out: the luma that they show now.
#pragma once

#include <span>
#include <vector>

#include "common/color.h"
#include "server/render/framelet_renderer.h"
#include "server/render/probe.h"

namespace framelet {

/// Renders single samples and shows them as `to_display` does; keeps its scratch.
class ProbeRenderer {
public:
    /// Renders the probes, in parallel on the calling TBB arena. Returns how many rays that took.
    std::uint64_t render(RenderScene const& scene, Camera const& camera, Viewport viewport,
                         DisplayTransform const& transform, std::span<Probe const> probes);
    /// What the probes that were rendered last show; valid until the next call.
    ProbeLooks looks() const { return {luma_, light_}; }

private:
    std::vector<Vec2> positions_;
    std::vector<float> spacings_;
    std::vector<Vec3> radiance_;
    std::vector<float> luma_;
    std::vector<SampleLight> light_;
};

} // namespace framelet
