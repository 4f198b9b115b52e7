// The statistics that the windowless client prints at its end.
#pragma once

#include <string>

#include "client/core/client_core.h"

namespace framelet {

/// Figures of a run that only the program knows.
struct RunFigures {
    std::string scene;
    Viewport viewport;
    std::uint64_t frames = 0; ///< display frames
    std::uint64_t late_frames = 0; ///< shown more than one frame's time too late
    double photon_seconds = -1; ///< motion to photon, median of the pictures that show something newer; -1: none did
    double still_difference = -1; ///< of `SheetMoments::difference`; -1: there are no stills
    SceneTime scene_seconds = 0; ///< what the scene's clock stood at when the last frame was shown
    double converged_seconds = -1; ///< from the start until everything had arrived; -1: not seen
};

/// One JSON object, indented.
std::string statistics_json(ClientStatistics const& statistics, RunFigures const& run);
/// A few lines for people, and below them details for who looks into what it costs.
std::string statistics_summary(ClientStatistics const& statistics, RunFigures const& run);

} // namespace framelet
