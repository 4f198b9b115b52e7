// Keeps what a run of framelet-client showed at some moments, and gets the stills of these, for which it waits when the
// run is over. In: frames, then the session. Out: pairs for a contact sheet.
#pragma once

#include <chrono>
#include <span>
#include <vector>

#include "client/core/client_core.h"
#include "client/sheet/contact_sheet.h"

namespace framelet {

/// The camera and the scene time of a frame.
struct ShownMoment {
    Camera camera;
    int scene_camera = -1; ///< as in `ClientCore::set_view`
    SceneTime time = 0;
};

class SheetMoments {
public:
    static constexpr int count = 3;

    /// Moments after a quarter, a half and three quarters of a run of that length; each still is waited for so long.
    explicit SheetMoments(double run_seconds, std::chrono::seconds patience = std::chrono::seconds(60))
        : run_seconds_(run_seconds), patience_(patience) {}

    /// Notes a frame that was shown `seconds` after the run began: keeps the first one at each of the moments.
    void note(double seconds, Picture const& shown, ShownMoment const& of);

    /// Asks the server for each moment with the clock standing, and waits for its still; the clock goes on afterwards
    /// where it was. Throws InputError where another viewer controls the clock that has to be set for it,
    /// ConnectionError where the session ends or the clock cannot be set. A still that does not become complete in time
    /// is as it is by then.
    void take_stills(ClientCore& core);

    /// The pairs, whose stills `take_stills` has made; empty where the run ended before the first moment.
    std::span<ShownAndStill const> pairs() const { return pairs_; }
    /// Stills that had not become complete when `patience` ended.
    int unfinished() const { return unfinished_; }
    std::chrono::seconds patience() const { return patience_; }
    /// The mean of all pairs' `mean_difference`; -1 where there are none.
    double difference() const;

private:
    double run_seconds_;
    std::chrono::seconds patience_;
    std::vector<ShownMoment> moments_; ///< of each pair
    std::vector<ShownAndStill> pairs_;
    int unfinished_ = 0;
};

} // namespace framelet
