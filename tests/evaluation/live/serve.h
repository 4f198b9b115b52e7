// Server and viewer of any method of the evaluation as real programs: the project's server with the method's stream,
// and a viewer that shows what the method makes of it.
#pragma once

#include <filesystem>
#include <string>

#include "client/core/camera/camera_path.h"
#include "client/core/connection/server_address.h"
#include "tests/evaluation/method.h"

namespace framelet::bench {

struct ServeOptions {
    std::string method;
    std::filesystem::path scene;
    float exposure_ev = 0; ///< stops
    int threads = 0; ///< 0: one a core
    RivalParts rivals; ///< the same for both programs
    CostTable costs;
};

/// Prints "listening on HOST:PORT"; until a signal ends it.
void serve_method(ServeOptions const& options);

struct LookOptions {
    std::string method;
    std::filesystem::path scene; ///< the methods are told what the server serves
    ConnectionOptions connection;
    Viewport viewport;
    double duration = 4;
    double rate = 60;
    std::string camera_file;
    std::string output;
    std::vector<double> output_times; ///< as in FrameChoice
    std::string frames_file;
    RivalParts rivals;
    CostTable costs;
};

/// Shows frames as framelet-client does, and writes what that writes.
void look_at_method(LookOptions const& options);

} // namespace framelet::bench
