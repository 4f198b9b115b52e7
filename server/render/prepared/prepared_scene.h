// Everything that tracing and shading read, in one place. Built and moved by RenderScene, constant while rendering.
#pragma once

#include <array>
#include <vector>

#include "common/tone_inverse.h"
#include "server/render/light/environment.h"
#include "server/render/light/lamp_sizes.h"
#include "server/render/light/light.h"
#include "server/render/light/split_sum.h"
#include "server/render/surface/embree_scene.h"

namespace framelet {

/// What is known of other scene times, of those that `motion_step` names, where something moves.
struct MotionTimes {
    /// False for times between which and the present one the scene jumps: they say nothing of how things go on.
    std::array<bool, motion_times> usable{};
    std::array<std::vector<RenderLight>, motion_times> lights;
    /// By body: what it takes a point of the world from the present time to the other one. Empty where nothing drifts.
    std::array<std::vector<WorldPlacement>, motion_times> of_body;
};

/// Seconds from the present scene time to the other ones.
inline constexpr float motion_step = 0.05f;
inline constexpr std::array<float, motion_times> motion_seconds{-motion_step, motion_step, 2 * motion_step,
                                                                6 * motion_step};

class LightCache;

struct PreparedScene {
    MaterialLibrary library;
    std::vector<std::vector<Geometry>> meshes; ///< by BVH number; the BVH points at the elements
    std::vector<Instance> instances; ///< by BVH number
    EmbreeScene bvh;
    std::vector<RenderLight> lights;
    MotionTimes times; ///< what is known of how things move
    Environment environment = Environment::uniform(Vec3(0));
    SplitSumTable split_sum;
    LightCache* light_cache = nullptr; ///< says what arrives from all around; null: the environment, unshadowed
    LampSizes lamp_sizes; ///< of `lights`
    /// By which the colours of unlit surfaces are seen as they are. The exposure that a viewer adds counts.
    DisplayTransform display{1, ToneCurve::linear};
    bool moves = false; ///< something moves: tracing keeps which surface gives a sample its depth
    bool throws_moving_shadows = false; ///< something moves so fast that its shadow does not stay
    bool see_through = false; ///< some material lets rays pass: without, no ray is ever continued behind a surface

    /// The radiance of an unlit surface of this colour, as the camera sees it.
    Vec3 unlit_radiance(Vec3 const& color) const { return radiance_shown_as(color, display.curve) / display.exposure; }
};

} // namespace framelet
