// Runs server and viewer of any method of the evaluation as real programs: the project's server with the method's
// stream, and a viewer that shows what the method makes of it.
#pragma once

#include <filesystem>
#include <string>

#include "client/core/camera/camera_path.h"
#include "protocol/connection/server_address.h"
#include "tests/evaluation/method.h"

namespace framelet::bench {

struct ServeOptions {
    std::string method;
    std::filesystem::path scene;
    float exposure_ev = 0; ///< stops
    int threads = 0; ///< 0: one a core
    std::string light = "direct";
    RivalParts rivals; ///< parts of the rivals; the same for both programs
    CostTable costs;
};

/// Serves a method until a signal ends it; prints "listening on HOST:PORT" first.
void serve_method(ServeOptions const& options);

struct LookOptions {
    std::string method;
    std::filesystem::path scene; ///< the scene that the server serves; methods need it
    ConnectionOptions connection;
    Viewport viewport;
    double duration = 4;
    double rate = 60;
    std::string camera_file;
    std::string output;
    std::vector<double> output_times; ///< times of the frames to write, as in FrameChoice
    std::string frames_file;
    RivalParts rivals;
    CostTable costs;
};

/// Shows frames and writes files as framelet-client does.
void look_at_method(LookOptions const& options);

} // namespace framelet::bench
