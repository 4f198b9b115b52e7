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

void CameraController::set_pivot(Vec3 point) {
    Vec3 const place = glm::conjugate(camera_.orientation) * (point - camera_.position);
    float const distance = glm::length(place);
    if (place.z < -1e-5f * size_ && distance <= 1e3f * size_) { // false for NaN, too
        pivot_ = place;
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

void CameraController::fit(Viewport viewport) {
    if (scene_.empty() || size_ >= largest_scene) {
        return;
    }
    float const aspect = static_cast<float>(viewport.width) / static_cast<float>(viewport.height);
    bool const is_perspective = camera_.projection == Projection::perspective;
    float const slope = is_perspective ? std::tan(0.5f * camera_.vertical_extent) : 0;
    float distance = 0; // from the scene's centre, such that every corner is within the picture; metres
    float height = 0; // of an orthographic picture that has every corner in it; metres
    for (int i = 0; i < 8; ++i) {
        Vec3 const side = Vec3(i & 1, i >> 1 & 1, i >> 2) - 0.5f;
        Vec3 const corner = glm::conjugate(camera_.orientation) * (side * scene_.size());
        float const half = std::max(std::abs(corner.x) / aspect, std::abs(corner.y));
        distance = std::max(distance, corner.z + (is_perspective ? half / slope : size_));
        height = std::max(height, 2 * half);
    }
    if (!is_perspective) {
        camera_.vertical_extent = height;
    }
    pivot_ = Vec3(0, 0, -distance);
    go_to(scene_.center() - camera_.orientation * pivot_);
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
