// A server in this process on a free port, and a scene for it. For tests only.
#pragma once

#include <thread>

#include "server/session/server.h"

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

class RunningServer {
public:
    explicit RunningServer(ServerOptions options = {}, Scene scene = triangle_scene())
        : scene_(std::move(scene)), render_scene_(scene_, std::nullopt),
          server_(scene_, default_clips(scene_), render_scene_, on_free_port(options)),
          thread_([this] { server_.run(false); }) {}
    ~RunningServer() { server_.stop(); }

    std::uint16_t port() const { return server_.port(); }

private:
    static ServerOptions on_free_port(ServerOptions options) {
        options.port = 0;
        return options;
    }

    Scene const scene_;
    RenderScene render_scene_;
    Server server_;
    std::jthread thread_;
};

} // namespace framelet
