#include "client/core/camera/camera_controller.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace framelet {

namespace {

constexpr float pi = std::numbers::pi_v<float>;
/// Steepest pitch of the view, up or down, radians: just short of vertical.
constexpr float steepest = 0.499f * pi;
constexpr float dolly_step = 0.9f;
constexpr float halfway_steps = 6.5788f; ///< steps of `dolly` that go half of the way: 0.9 to this power is a half
constexpr float fast_factor = 4;
constexpr float speed_step = 1.25f;
/// Diagonal, metres, up to which all scenes are crossed in the same time; larger ones are travelled faster, but by the
/// square root only: what one goes past in a landscape is still as large as a house.
constexpr float room_size = 30;
/// Largest coordinate of the camera's position and largest diagonal of a scene that count, metres: nobody sees anything
/// from farther away, and arithmetic stays finite.
constexpr float farthest = 1e9f;
constexpr float largest_scene = 1e7f;
/// Room around a scene that is fitted into the picture, in halves of the picture's shorter side.
constexpr float fit_margin = 0.08f;
/// Most of the picture's height that counts as covered then, in halves of it: a small window has little else.
constexpr float most_covered = 1.5f;
/// Least distance from the scene then, and least height of an orthographic picture, in its diagonals.
constexpr float least_fit_distance = 0.05f;

/// Farthest point that is taken hold of, in distances to the farthest corner of the scene: depths are rounded.
constexpr float hold_margin = 1.1f;

Vec3 in_camera_space(Camera const& camera, Vec3 point) {
    return glm::conjugate(camera.orientation) * (point - camera.position);
}

/// Somebody who stands on the ground looks up less steeply than this, by the sine; and down so far, radians, where
/// backing off would lead below it.
constexpr float most_look_up = 0.5f;
constexpr float look_down = 0.25f;

float diagonal(Bounds const& scene) {
    float const length = scene.empty() ? 0 : glm::length(scene.size());
    return std::isfinite(length) && length > 0 ? std::min(length, largest_scene) : 1;
}

} // namespace

CameraController::CameraController(Camera const& home, Bounds const& scene)
    : home_(home), scene_(scene), size_(diagonal(scene)), reach_(std::min(size_, std::sqrt(room_size * size_))),
      camera_(home) {
    reset();
}

void CameraController::set_camera(Camera const& camera) {
    camera_ = camera;
    if (camera.projection == Projection::perspective) {
        field_of_view_ = camera.vertical_extent;
    }
    Vec3 const center =
        scene_.empty() || size_ >= largest_scene ? camera.position + camera.forward() * size_ : scene_.center();
    float const along = glm::dot(center - camera.position, camera.forward());
    float distance = along > 1e-3f * size_ ? along : reach_ / 4;
    Vec3 const place = camera.position;
    if (glm::clamp(place, scene_.lower, scene_.upper) == place) {
        distance = std::min(distance, reach_ / 10); // amid the scene one looks at what is near
    }
    pivot_ = Vec3(0, 0, -distance);
}

void CameraController::go_to(Vec3 position) {
    camera_.position = glm::clamp(position, Vec3(-farthest), Vec3(farthest));
}

void CameraController::turn(float yaw, float pitch) {
    float const height = std::asin(std::clamp(camera_.forward().y, -1.0f, 1.0f));
    // A view that is already steeper (or upside down) may stay so, but not tip further.
    float const low = std::min(-steepest, height);
    float const high = std::max(steepest, height);
    pitch = std::clamp(height + pitch, low, high) - height;
    Quat const around_up = glm::angleAxis(yaw, Vec3(0, 1, 0));
    Quat const around_right = glm::angleAxis(pitch, Vec3(1, 0, 0)); // in camera space
    camera_.orientation = glm::normalize(around_up * camera_.orientation * around_right);
}

void CameraController::orbit(Vec2 pixels, Viewport viewport) {
    if (pixels == Vec2(0, 0)) { // to go around a pivot that is far away moves the camera by its rounding
        return;
    }
    Vec3 const center = pivot();
    Vec2 const angle = pixels * (pi / static_cast<float>(viewport.height));
    turn(-angle.x, -angle.y);
    go_to(center - camera_.orientation * pivot_);
}

void CameraController::look(Vec2 pixels, Viewport viewport) {
    Vec2 const angle = pixels * (pi / 2 / static_cast<float>(viewport.height));
    turn(-angle.x, -angle.y);
}

void CameraController::pan(Vec2 pixels, Viewport viewport) {
    float const height = camera_.projection == Projection::perspective
                             ? 2 * std::tan(0.5f * camera_.vertical_extent) * -pivot_.z
                             : camera_.vertical_extent;
    Vec2 const metres = pixels * (height / static_cast<float>(viewport.height));
    go_to(camera_.position + camera_.up() * metres.y - camera_.right() * metres.x);
}

void CameraController::dolly(float steps) {
    if (steps == 0) { // likewise
        return;
    }
    float const scale = std::pow(dolly_step, steps);
    if (camera_.projection == Projection::orthographic) {
        camera_.vertical_extent = std::clamp(camera_.vertical_extent * scale, 1e-5f * size_, 1e3f * size_);
        return;
    }
    Vec3 const center = pivot();
    float const distance = glm::length(pivot_);
    pivot_ *= std::clamp(distance * scale, 1e-5f * size_, 1e3f * size_) / distance;
    go_to(center - camera_.orientation * pivot_);
}

bool CameraController::can_hold(Camera const& camera, Vec3 point) const {
    Vec3 const corner = glm::max(glm::abs(scene_.lower - camera.position), glm::abs(scene_.upper - camera.position));
    float const farthest_hold =
        scene_.empty() || size_ >= largest_scene ? 1e3f * size_ : hold_margin * glm::length(corner);
    Vec3 const place = in_camera_space(camera, point);
    return place.z < -1e-5f * size_ && glm::length(place) <= farthest_hold; // false for NaN, too
}

void CameraController::set_pivot(Vec3 point) {
    if (can_hold(camera_, point)) {
        pivot_ = in_camera_space(camera_, point);
    }
}

void CameraController::focus(Vec3 point) {
    set_pivot(point);
    Vec3 const target = pivot();
    float const distance = glm::length(pivot_);
    camera_.orientation = look_at(camera_.position, target, Vec3(0, 1, 0), 1).orientation;
    pivot_ = Vec3(0, 0, -distance);
    dolly(halfway_steps);
    go_to(target - camera_.orientation * pivot_);
}

void CameraController::look_along(Vec3 forward, Vec3 up) {
    Vec3 const center = pivot();
    camera_.orientation = look_at(Vec3(0, 0, 0), forward, up, 1).orientation;
    pivot_ = Vec3(0, 0, -glm::length(pivot_));
    go_to(center - camera_.orientation * pivot_);
}

void CameraController::toggle_projection() {
    float const slope = 2 * std::tan(0.5f * field_of_view_); // height of the picture at a distance of one metre, metres
    if (camera_.projection == Projection::perspective) {
        camera_.projection = Projection::orthographic;
        camera_.vertical_extent = std::clamp(slope * -pivot_.z, 1e-5f * size_, 1e3f * size_);
        return;
    }
    Vec3 const center = pivot();
    pivot_.z = -std::clamp(camera_.vertical_extent / slope, 1e-5f * size_, 1e3f * size_);
    camera_.projection = Projection::perspective;
    camera_.vertical_extent = field_of_view_;
    go_to(center - camera_.orientation * pivot_);
}

void CameraController::fit(Viewport viewport, int covered_below) {
    if (scene_.empty() || size_ >= largest_scene) {
        return;
    }
    bool const stands_on_it = camera_.position.y >= scene_.lower.y && camera_.forward().y < most_look_up;
    back_off(viewport, covered_below);
    if (stands_on_it && camera_.position.y < scene_.lower.y) {
        turn(0, -look_down - std::asin(std::clamp(camera_.forward().y, -1.0f, 1.0f)));
        back_off(viewport, covered_below);
    }
}

void CameraController::back_off(Viewport viewport, int covered_below) {
    // The part of the picture that is free, in halves of its height from the middle, x right, y up.
    auto const height = static_cast<float>(viewport.height);
    float const aspect = static_cast<float>(viewport.width) / height;
    float const margin = fit_margin * std::min(aspect, 1.0f);
    float const right = aspect - margin;
    float const top = 1 - margin;
    float const bottom = -1 + std::min(2 * static_cast<float>(covered_below) / height, most_covered) + margin;
    bool const is_perspective = camera_.projection == Projection::perspective;
    // The planes through its edges are moved inwards until each touches the scene: each bounds where the camera may be,
    // in camera space about the scene's centre. An orthographic camera's are parallel.
    float const slope = is_perspective ? std::tan(0.5f * camera_.vertical_extent) : 0;
    Vec3 most(-INFINITY);
    float to_right = -INFINITY, to_left = INFINITY, above = -INFINITY, below = INFINITY;
    for (int i = 0; i < 8; ++i) {
        Vec3 const side = Vec3(i & 1, i >> 1 & 1, i >> 2) - 0.5f;
        Vec3 const corner = glm::conjugate(camera_.orientation) * (side * scene_.size());
        most = glm::max(most, corner);
        to_right = std::max(to_right, corner.x + right * slope * corner.z);
        to_left = std::min(to_left, corner.x - right * slope * corner.z);
        above = std::max(above, corner.y + top * slope * corner.z);
        below = std::min(below, corner.y + bottom * slope * corner.z);
    }
    Vec3 eye(0);
    if (is_perspective) {
        eye.z = std::max({(to_right - to_left) / (2 * right * slope), (above - below) / ((top - bottom) * slope),
                          most.z + least_fit_distance * size_});
        eye.x = 0.5f * (to_right + to_left);
        eye.y = 0.5f * (above + below - (top + bottom) * slope * eye.z);
    } else {
        camera_.vertical_extent =
            std::max({(to_right - to_left) / right, 2 * (above - below) / (top - bottom), least_fit_distance * size_});
        eye.z = most.z + size_;
        eye.y = -0.25f * (top + bottom) * camera_.vertical_extent;
    }
    pivot_ = -eye;
    go_to(scene_.center() + camera_.orientation * eye);
}

float CameraController::fly_speed() const {
    return reach_ / 8 * speed_;
}

void CameraController::change_speed(float steps) {
    set_speed_factor(speed_ * std::pow(speed_step, steps));
}

void CameraController::set_speed_factor(float factor) {
    speed_ = std::clamp(factor, 1 / most_speed_factor, most_speed_factor);
}

void CameraController::fly(FlyInput const& input, double seconds) {
    if (!input.moving()) {
        return;
    }
    auto const time = static_cast<float>(seconds);
    Vec2 const angle = input.turn * (pi / 2 * time / std::max(glm::length(input.turn), 1.0f));
    turn(-angle.x, -angle.y);
    float const speed = fly_speed() * (input.fast ? fast_factor : 1);
    Vec3 const direction = input.direction / std::max(glm::length(input.direction), 1.0f);
    go_to(camera_.position + camera_.orientation * direction * (speed * time));
}

} // namespace framelet
