// The states of what is to be seen, and of what is rendered of it.
#pragma once

#include "common/color.h"
#include "common/framelet/framelet.h"

namespace framelet {

/// State of what is to be seen. The picture on screen is worth refining for as long as this stays the same.
struct ViewState {
    NumberedView view;
    DisplayTransform transform; ///< of radiance
    SceneTime scene_time = 0; ///< 0 where nothing moves
};

/// The moment that is rendered for a while instead of the present: a viewer that moves what it holds loses little by
/// it, and has to join samples of few moments only.
struct HeldMoment {
    ViewState state;
    double begun = 0; ///< when it was the present, seconds, steady
    double seconds = 0; ///< the next one begins at a multiple of this, seconds, steady
    SceneTime shown_from = 0; ///< as `Batch::shown_from`
    bool outdates = false; ///< as `Batch::outdates`
};

/// True when both show the same picture; the number of the camera does not matter.
inline bool same_picture(ViewState const& a, ViewState const& b) {
    return a.view.camera == b.view.camera && a.view.viewport == b.view.viewport && a.transform == b.transform &&
           a.scene_time == b.scene_time;
}

} // namespace framelet
