#include "tests/evaluation/live/live_frames.h"

#include <algorithm>
#include <ctime>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "common/cpu_clock.h"

namespace framelet::bench {

using nlohmann::json;

namespace {

LiveFrame parse_frame(json const& line) {
    LiveFrame frame{line["frame"],
                    line["unix_seconds"],
                    line["scene_seconds"],
                    line["changed"],
                    line["bytes"],
                    line["samples"],
                    line["cpu_seconds"],
                    line["photon_seconds"],
                    {},
                    0};
    json const& position = line["position"];
    json const& turn = line["orientation"];
    frame.camera.position = {position[0], position[1], position[2]};
    frame.camera.orientation = Quat(turn[0], turn[1], turn[2], turn[3]);
    frame.camera.vertical_extent = line["vertical_extent"];
    frame.scene_camera = line["scene_camera"];
    return frame;
}

} // namespace

std::vector<LiveFrame> read_frames(std::filesystem::path const& file) {
    std::vector<LiveFrame> frames;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line) && !stream.eof();) {
        frames.push_back(parse_frame(json::parse(line)));
    }
    return frames;
}

double cpu_of(pid_t pid) {
    clockid_t clock{};
    return clock_getcpuclockid(pid, &clock) == 0 ? cpu_seconds_of(clock) : 0;
}

double percentile(std::vector<double> values, double share) {
    if (values.empty()) {
        return 0;
    }
    auto const at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

} // namespace framelet::bench
