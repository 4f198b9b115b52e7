// Makes a session with a virtual clock, for play_session: web_session SCENE FILE. The file holds frames as they go over
// a connection, in their order: what the viewer looks at, batches, and a Status for each picture that is to be made.
#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <iostream>

#include <glm/gtc/quaternion.hpp>

#include "protocol/stream/message_frame.h"
#include "server/scene/scene_import.h"
#include "server/stream/framelet_stream.h"

namespace framelet {
namespace {

constexpr double picture_seconds = 1.0 / 30;
constexpr double moving_seconds = 1.5; // then the camera stands, and the clock
constexpr double most_seconds = 60;
constexpr double samples_per_second = 4e6;
constexpr Viewport viewport{480, 270};

void put(std::ofstream& out, Message const& message) {
    Bytes const frame = frame_of(message);
    out.write(reinterpret_cast<char const*>(frame.data()), static_cast<std::streamsize>(frame.size()));
}

void make_session(std::filesystem::path const& file, std::ofstream& out) {
    Scene const scene = import_scene(file);
    RenderScene render_scene(scene, std::nullopt);
    PosedScene posed(scene, {0}, render_scene);
    FrameletStream stream({}, coding::all);
    stream.take({0, ViewerSettings{}});
    Camera const start = posed.camera(0, 0);
    Status status;
    for (double now = 0; now < most_seconds && !status.converged; now += picture_seconds) {
        double const moved = std::min(now, moving_seconds);
        if (now <= moving_seconds) {
            Camera camera = start;
            camera.position += static_cast<float>(0.5 * moved) * start.right();
            camera.orientation =
                glm::angleAxis(static_cast<float>(0.2 * std::sin(2 * moved)), Vec3(0, 1, 0)) * start.orientation;
            CameraUpdate const update{{++status.camera_number, camera, viewport}, -1};
            stream.take({now, update});
            put(out, update);
        }
        double const speed = now < moving_seconds ? 1 : 0;
        if (stream.plan({now, moved, speed, samples_per_second, 1e-3}, posed) == Step::render) {
            posed.pose(stream.moment());
            stream.render(posed);
            if (stream.learn(posed)) {
                EncodedBatch const batch = stream.encode();
                put(out, batch);
                stream.take({now, BatchSent{batch.number, batch.payload.size()}});
                stream.take({now + 0.5 * picture_seconds, Ack{batch.number, 0, 0}});
            }
        }
        status.clock = {moved, speed > 0, 1};
        status.last_batch = stream.last_batch();
        status.converged = now > moving_seconds && stream.is_complete();
        put(out, status);
    }
}

} // namespace
} // namespace framelet

int main(int count, char** arguments) {
    if (count != 3) {
        return 2;
    }
    try {
        std::ofstream out(arguments[2], std::ios::binary);
        framelet::make_session(arguments[1], out);
        return out.flush() ? 0 : 1;
    } catch (std::exception const& error) {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
