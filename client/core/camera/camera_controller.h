// Moves the camera as the user's hands say: orbit, pan, dolly, fly, focus, look along an axis. In: pointer movement in
// pixels, held keys and seconds. Out: a camera. Works alike for scenes of a few centimetres and of kilometres, and at
// any frame rate.
#pragma once

#include "common/camera.h"

namespace framelet {

/// Direction in which the flying keys and the gamepad's sticks point.
struct FlyInput {
    Vec3 direction{0, 0, 0}; ///< in camera space: x right, y up, z backwards; a length of 1 or more is the whole speed
    Vec2 turn{0, 0}; ///< turn of the head: x right, y down; a length of 1 or more is the whole speed
    bool fast = false; ///< four times the speed; the head turns no faster

    bool moving() const { return direction != Vec3(0, 0, 0) || turn != Vec2(0, 0); }
};

class CameraController {
public:
    /// `home` is where `reset` goes back to; `scene` tells the size of things (it may be empty).
    CameraController(Camera const& home, Bounds const& scene);

    Camera const& camera() const { return camera_; }
    /// Goes on from another camera; its pivot is the point of its axis that is nearest to the scene's centre, or amid
    /// the scene one close by.
    void set_camera(Camera const& camera);
    void reset() { set_camera(home_); }

    /// True for a point that this camera can have for its pivot: not one behind it, nor one farther away than all of
    /// the scene, as its backdrop is (the scene is told without one), nor one that is not finite.
    bool can_hold(Camera const& camera, Vec3 point) const;
    /// Sets the pivot: the point that the camera orbits and nears, and by whose depth it pans. Does nothing where the
    /// camera cannot hold it.
    void set_pivot(Vec3 point);
    /// Turns to a point, goes half of the way there, and has it for its pivot. World up becomes up.
    void focus(Vec3 point);
    /// Backs off, or nears, until all of the scene is in the picture, seen from the same direction, with a margin. One
    /// who stands above the scene's lower edge and looks up a little looks down instead, where that led below it.
    /// `covered_below`: pixels at the lower edge that something else lies over, of which it stays clear.
    void fit(Viewport viewport, int covered_below = 0);

    /// Turns around the pivot, which comes into the middle of the picture, until it looks along this axis of the world.
    void look_along(Vec3 forward, Vec3 up);
    /// Switches from perspective to orthographic or back; what lies as deep as the pivot stays as large as it is.
    void toggle_projection();

    /// Turns the camera around the pivot, which stays where it is in the picture: the picture's whole height is half a
    /// turn. World up stays up.
    void orbit(Vec2 pixels, Viewport viewport);
    /// Moves the camera across the picture: what lies as deep as the pivot follows the pointer.
    void pan(Vec2 pixels, Viewport viewport);
    /// Moves the camera towards (positive) or away from the pivot, which stays where it is in the picture: a step is a
    /// tenth of the way; never through it. An orthographic camera's picture is scaled likewise.
    void dolly(float steps);
    /// Flies through the scene with `fly_speed` for so many seconds. The head turns by a quarter turn a second at most.
    void fly(FlyInput const& input, double seconds);
    /// The speed of flying, metres a second: an eighth of the scene's diagonal, in large scenes less (2 km: 30 m/s),
    /// times the factor that `change_speed` has set.
    float fly_speed() const;
    /// Makes flying a quarter faster (positive) or slower with each step.
    void change_speed(float steps);
    /// The factor that `change_speed` has set, 1 at first: 100 at most, and no less than 1/100.
    float speed_factor() const { return speed_; }
    /// Sets that factor; one beyond these bounds becomes the nearest within.
    void set_speed_factor(float factor);
    static constexpr float most_speed_factor = 100;
    /// Turns the head in place, to where the pointer goes: the picture's whole height is a quarter turn.
    void look(Vec2 pixels, Viewport viewport);

    Vec3 pivot() const { return camera_.position + camera_.orientation * pivot_; }

private:
    void turn(float yaw, float pitch);
    void go_to(Vec3 position);
    void back_off(Viewport viewport, int covered_below);

    Camera home_;
    Bounds scene_;
    float size_; ///< the scene's diagonal, metres
    float reach_; ///< how far one goes in a few seconds, metres
    float speed_ = 1; ///< factor on the speed that suits the scene
    Camera camera_;
    float field_of_view_ = Camera().vertical_extent; ///< vertical, of the last perspective camera; radians
    Vec3 pivot_{0, 0, -1}; ///< in camera space: it goes with the camera
};

} // namespace framelet
