// A server in this process on a free port. For tests only.
#pragma once

#include <thread>

#include "server/session/server.h"
#include "server/stream/posed_scene.h"
#include "tests/session/triangle_scenes.h"

namespace framelet {

class RunningServer {
public:
    explicit RunningServer(ServerOptions options = {}, Scene scene = triangle_scene(), LightOptions const& light = {})
        : scene_(std::move(scene)), render_scene_(scene_, std::nullopt),
          posed_(scene_, default_clips(scene_), render_scene_, light), server_(posed_, on_free_port(options)),
          thread_([this] { server_.run(); }) {}
    ~RunningServer() { server_.stop(); }

    std::uint16_t port() const { return server_.port(); }
    ServerFigures figures() const { return server_.figures(); }

private:
    static ServerOptions on_free_port(ServerOptions options) {
        options.port = 0;
        return options;
    }

    Scene const scene_;
    RenderScene render_scene_;
    PosedScene posed_;
    Server server_;
    std::jthread thread_;
};

} // namespace framelet
