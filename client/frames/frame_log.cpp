#include "client/frames/frame_log.h"

#include <nlohmann/json.hpp>

#include "common/error.h"

namespace framelet {

FrameLog::FrameLog(std::filesystem::path const& file) : file_(file), stream_(file) {
    if (!stream_) {
        throw InputError("cannot write '" + file.string() + "'");
    }
}

void FrameLog::add(FrameEntry const& entry) {
    glm::dvec3 const position = entry.origin + glm::dvec3(entry.camera.position);
    Quat const& turn = entry.camera.orientation;
    nlohmann::ordered_json const line = {{"frame", entry.frame},
                                         {"unix_seconds", entry.unix_seconds},
                                         {"scene_seconds", entry.scene_seconds},
                                         {"changed", entry.changed},
                                         {"complete", entry.complete},
                                         {"bytes", entry.bytes},
                                         {"cpu_seconds", entry.cpu_seconds},
                                         {"samples", entry.samples},
                                         {"photon_seconds", entry.photon_seconds},
                                         {"scene_camera", entry.scene_camera},
                                         {"position", {position.x, position.y, position.z}},
                                         {"orientation", {turn.w, turn.x, turn.y, turn.z}},
                                         {"vertical_extent", entry.camera.vertical_extent}};
    stream_ << line << '\n';
    if (!stream_.flush()) {
        throw InputError("cannot write '" + file_.string() + "'");
    }
}

} // namespace framelet
