// Scenes that direct light shows badly: most of what is seen in them is lit by what other things reflect, or by things
// that glow.
#pragma once

#include "scenes/gltf/gltf_document.h"

namespace framelet {

/// A furnished room with a window to the sun, a standing lamp, and a door to a lit hall that opens and closes.
struct InteriorParameters {
    double duration = 8; ///< seconds
    double door_degrees = 100; ///< by which the door opens
    double drift = 0.15; ///< of the camera: metres to either side
};
GltfDocument make_interior_scene(InteriorParameters const& parameters);

/// A street at dusk between houses whose windows are lit; a car comes, somebody walks below the lamps.
struct DuskParameters {
    double duration = 6; ///< seconds
};
GltfDocument make_dusk_scene(DuskParameters const& parameters);

} // namespace framelet
