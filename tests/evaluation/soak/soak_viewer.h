// A viewer that stays while it storms: the real client core behind a link of its own that can be cut. In: events, time.
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

/// What a viewer sees at rest.
struct StillView {
    Camera camera;
    Viewport viewport;
    SceneTime time = 0; ///< at which the scene stands
};

class SoakViewer {
public:
    /// Connects to the server at this port. Throws ConnectionError where that is refused.
    SoakViewer(std::uint16_t server_port, LinkParameters const& link, Viewport viewport);

    /// One of the events that happen to viewers.
    void take(StormMoment const& moment);
    /// Flies there and back, or looks around where there is no flight, and makes a picture of what is there. `now`:
    /// seconds.
    void move(double now, std::optional<CameraPath> const& flight);
    /// Asks for this view and no other from here on, for the usual settings, and, where it may, for that time; makes a
    /// picture. True once the picture is complete.
    bool come_to_rest(StillView const& view);
    Picture const& picture() const { return picture_; }

    Camera start_camera() const { return core_.welcome().start_camera; }
    std::uint64_t reconnections() const { return core_.statistics().reconnections; }
    /// Why it has ended for good, which it must not; empty: it has not.
    std::string end_reason() const { return core_.end_reason().value_or(""); }

private:
    LinkEmulator link_;
    ClientCore core_;
    Viewport viewport_;
    ViewerSettings settings_;
    Picture picture_;
    std::vector<PixelRect> changed_; ///< scratch
    std::chrono::steady_clock::time_point clock_asked_;
};

} // namespace framelet::bench
