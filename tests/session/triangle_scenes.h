// The least scenes that a server can serve. For tests only.
#pragma once

#include "server/scene/scene.h"

namespace framelet {

/// One triangle in front of the origin, and a box-free background.
inline Scene triangle_scene() {
    Scene scene;
    scene.name = "triangle";
    scene.materials.emplace_back();
    Primitive primitive;
    primitive.positions = {{-1, -1, -5}, {1, -1, -5}, {0, 1, -5}};
    primitive.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    primitive.triangles = {{0, 1, 2}};
    scene.meshes.push_back({"triangle", {primitive}, {}});
    scene.nodes.emplace_back();
    scene.nodes.back().mesh = 0;
    return scene;
}

/// The same triangle, which goes to the side and back within two seconds.
inline Scene moving_scene() {
    Scene scene = triangle_scene();
    scene.clips.resize(1);
    scene.clips[0].duration = 2;
    scene.clips[0].channels.push_back(
        {0, AnimatedProperty::translation, Interpolation::linear, 3, {0, 1, 2}, {0, 0, 0, 1, 0, 0, 0, 0, 0}});
    return scene;
}

} // namespace framelet
