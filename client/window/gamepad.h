// Makes a gamepad fly the camera. In: its axes, as GLFW gives them. Out: the input that the flying keys would give.
#pragma once

#include "client/core/camera/camera_controller.h"

namespace framelet {

struct GamepadAxes {
    Vec2 left_stick{0, 0}, right_stick{0, 0}; ///< each -1 to 1; x right, y down
    float left_trigger = -1, right_trigger = -1; ///< -1 (let go) to 1
    bool bumper = false; ///< one of the two is held
};

/// The left stick moves, the right one turns the head, the right trigger goes up and the left one down, a bumper is
/// Shift. Sticks and triggers that are let go are never quite in their middle: what is near it is nothing.
FlyInput fly_input(GamepadAxes const& axes);

/// The input of keys and gamepad together.
FlyInput operator+(FlyInput const& a, FlyInput const& b);

} // namespace framelet
