// Everything that tracing and shading read, in one place. Built and moved by RenderScene, constant while rendering.
#pragma once

#include <vector>

#include "server/render/light/environment.h"
#include "server/render/light/light.h"
#include "server/render/light/split_sum.h"
#include "server/render/surface/embree_scene.h"

namespace framelet {

struct PreparedScene {
    MaterialLibrary library;
    std::vector<std::vector<Geometry>> meshes; ///< by BVH number; the BVH points at the elements
    std::vector<Instance> instances; ///< by BVH number
    EmbreeScene bvh;
    std::vector<RenderLight> lights;
    Environment environment = Environment::uniform(Vec3(0));
    SplitSumTable split_sum;
    bool moves = false; ///< something moves: tracing keeps which surface gives a sample its depth
    bool throws_moving_shadows = false; ///< something moves so fast that its shadow does not stay
    bool see_through = false; ///< some material lets rays pass: without, no ray is ever continued behind a surface
};

} // namespace framelet
