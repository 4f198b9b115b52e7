#include "client/window/gamepad.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace framelet {
namespace {

constexpr float least_stick = 0.15f;
constexpr float least_trigger = 0.1f;

/// The share of the whole speed for a deflection: from 0 at `least` to 1, slowly at first, since small movements are to
/// be small.
float response(float deflection, float least) {
    float const share = std::clamp((deflection - least) / (1 - least), 0.0f, 1.0f);
    return share * share;
}

Vec2 stick(Vec2 place) {
    float const deflection = glm::length(place);
    return deflection > least_stick ? place * (response(deflection, least_stick) / deflection) : Vec2(0, 0);
}

float trigger(float place) {
    return response(0.5f * (place + 1), least_trigger);
}

} // namespace

FlyInput fly_input(GamepadAxes const& axes) {
    FlyInput out;
    Vec2 const along = stick(axes.left_stick);
    out.direction = {along.x, trigger(axes.right_trigger) - trigger(axes.left_trigger), along.y};
    out.turn = stick(axes.right_stick);
    out.fast = axes.bumper;
    return out;
}

FlyInput operator+(FlyInput const& a, FlyInput const& b) {
    return {a.direction + b.direction, a.turn + b.turn, a.fast || b.fast};
}

} // namespace framelet
