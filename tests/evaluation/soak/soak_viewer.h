// A viewer that stays through storms: the real client core behind a link of its own that can be cut. In: events, time.
// Out: its last picture, once it stands still.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "client/core/camera/camera_path.h"
#include "client/core/client_core.h"
#include "tests/evaluation/codecs/link_emulator.h"
#include "tests/evaluation/soak/storm.h"

namespace framelet::bench {

/// View of a viewer at rest.
struct StillView {
    Camera camera;
    int scene_camera = -1; ///< >= 0: through that camera of the scene
    Viewport viewport;
    SceneTime time = 0; ///< scene time at which the scene stands
};

class SoakViewer {
public:
    /// Connects to the server at this port. Throws ConnectionError where that is refused.
    SoakViewer(std::uint16_t server_port, LinkParameters const& link, Viewport viewport);

    /// Undergoes one of the events that happen to viewers.
    void take(StormMoment const& moment);
    /// Flies there and back, or looks around where there is no flight, or looks through a camera of the scene
    /// (`scene_camera` >= 0), and makes a picture. `now`: seconds.
    void move(double now, std::optional<CameraPath> const& flight, int scene_camera);
    /// Asks for this view, for the usual settings and, at intervals, for the scene to stand at that time; makes a
    /// picture. True once the scene stands there and the picture is complete.
    bool come_to_rest(StillView const& view);
    Picture const& picture() const { return picture_; }

    Camera start_camera() const { return core_.welcome().start_camera; }
    std::uint64_t reconnections() const { return core_.statistics().reconnections; }
    /// Reason why the connection has ended for good, which it must not; empty: it has not.
    std::string end_reason() const { return core_.end_reason().value_or(""); }

private:
    LinkEmulator link_;
    ClientCore core_;
    Viewport viewport_;
    ViewerSettings settings_;
    Picture picture_;
    std::vector<PixelRect> changed_; ///< scratch of the picture's updates
    std::chrono::steady_clock::time_point clock_asked_;
};

} // namespace framelet::bench
