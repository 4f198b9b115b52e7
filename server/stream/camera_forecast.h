// Forecasts where a viewer's camera will be. In: its cameras, and when they came. Out: the camera a little later, if it
// goes on as it does.
#pragma once

#include <vector>

#include "common/camera.h"

namespace framelet {

class CameraForecast {
public:
    /// Takes in a camera and when it came, seconds; times never fall.
    void add(Camera const& camera, double seconds);
    /// Forgets all cameras: the next one is another, of which they say nothing.
    void forget() { known_.clear(); }
    /// The camera `ahead` seconds after `now`, which is no earlier than the last that was added, of which there is one.
    /// It has gone on as fast as it did in the last tenth of a second or so, as far as it did so in both halves of
    /// that: what has just begun, stops or jumps stays where it is.
    Camera at(double now, double ahead) const;

private:
    struct Known {
        Camera camera;
        double seconds = 0;
    };
    std::vector<Known> known_; ///< the last few, the newest at the end
};

} // namespace framelet
