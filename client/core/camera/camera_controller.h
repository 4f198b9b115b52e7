// What the hands do to the camera: orbit, pan, dolly, fly, focus, look along an axis. In: pointer movement in pixels,
// held keys and seconds. Out: a camera. Works alike for scenes of a few centimetres and of kilometres, and at any frame
// rate.
#pragma once

#include "common/camera.h"

namespace framelet {

/// Which way the flying keys and the gamepad's sticks point.
struct FlyInput {
    Vec3 direction{0, 0, 0}; ///< in camera space: x right, y up, z backwards; a length of 1 or more is the whole speed
    Vec2 turn{0, 0}; ///< of the head: x right, y down; likewise
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

    /// What the hands turn, drag and near from now on; not where it lies behind the camera or beyond all measure.
    void set_pivot(Vec3 point);
    /// Turns to a point, goes half of the way there, and has it for its pivot. World up becomes up.
    void focus(Vec3 point);
    /// Backs off, or nears, until all of the scene is in the picture, seen from the same direction.
    void fit(Viewport viewport);

    /// Turns around the pivot, which comes into the middle of the picture, until it looks along this axis of the world.
    void look_along(Vec3 forward, Vec3 up);
    /// From perspective to orthographic or back; what lies as deep as the pivot stays as large as it is.
    void toggle_projection();

    /// Around the pivot, which stays where it is in the picture: the picture's whole height is half a turn. World up
    /// stays up.
    void orbit(Vec2 pixels, Viewport viewport);
    /// Across the picture: what lies as deep as the pivot follows the pointer.
    void pan(Vec2 pixels, Viewport viewport);
    /// Towards (positive) or away from the pivot, which stays where it is in the picture: a step is a tenth of the way;
    /// never through it.
    void dolly(float steps);
    /// Through the scene with `fly_speed`. The head turns a quarter a second.
    void fly(FlyInput const& input, double seconds);
    /// Metres a second: an eighth of the scene's diagonal, in large scenes less (2 km: 30 m/s), times what
    /// `change_speed` was told.
    float fly_speed() const;
    /// Each step is a quarter faster (positive) or slower; never more than 100 times.
    void change_speed(float steps);
    /// Turns the head in place, to where the pointer goes: the picture's whole height is a quarter turn.
    void look(Vec2 pixels, Viewport viewport);

    Vec3 pivot() const { return camera_.position + camera_.orientation * pivot_; }

private:
    void turn(float yaw, float pitch);
    void go_to(Vec3 position);

    Camera home_;
    Bounds scene_;
    float size_; ///< the scene's diagonal, metres
    float reach_; ///< how far one goes in a few seconds, metres
    float speed_ = 1; ///< times what suits the scene
    Camera camera_;
    float field_of_view_ = Camera().vertical_extent; ///< that the last perspective camera had
    Vec3 pivot_{0, 0, -1}; ///< in camera space: it goes with the camera
};

} // namespace framelet
