// What is to be seen.
#pragma once

#include "common/framelet.h"

namespace framelet {

/// What is on screen is worth refining for as long as this stays the same.
struct ViewState {
    NumberedView view;
    float exposure = 1;
    SceneTime scene_time = 0; ///< 0 where nothing moves

    bool operator==(ViewState const&) const = default;
};

/// True when both show the same picture: the number of the camera apart.
inline bool same_picture(ViewState const& a, ViewState const& b) {
    return a.view.camera == b.view.camera && a.view.viewport == b.view.viewport && a.exposure == b.exposure &&
           a.scene_time == b.scene_time;
}

} // namespace framelet
