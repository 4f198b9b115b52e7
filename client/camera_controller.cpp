#include "client/camera_controller.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace framelet {

namespace {

constexpr float pi = std::numbers::pi_v<float>;
/// How near to straight up or down the view may tip.
constexpr float steepest = 0.499f * pi;
constexpr float dolly_step = 0.9f;
constexpr float fast_factor = 4;
/// Up to this size a scene is crossed in the same time; larger ones are travelled faster, but by the square root only:
/// what one goes past in a landscape is still as large as a house. Metres.
constexpr float room_size = 30;
/// Beyond this nobody sees anything, and arithmetic stays finite.
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
    Vec3 const center =
        scene_.empty() || size_ >= largest_scene ? camera.position + camera.forward() * size_ : scene_.center();
    float const along = glm::dot(center - camera.position, camera.forward());
    distance_ = along > 1e-3f * size_ ? along : reach_ / 4;
    Vec3 const place = camera.position;
    if (glm::clamp(place, scene_.lower, scene_.upper) == place) {
        distance_ = std::min(distance_, reach_ / 10); // amid the scene one looks at what is near
    }
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
    go_to(center - camera_.forward() * distance_);
}

void CameraController::look(Vec2 pixels, Viewport viewport) {
    float const field = camera_.projection == Projection::perspective ? camera_.vertical_extent : pi / 4;
    Vec2 const angle = pixels * (field / static_cast<float>(viewport.height));
    turn(angle.x, angle.y);
}

void CameraController::pan(Vec2 pixels, Viewport viewport) {
    float const height = camera_.projection == Projection::perspective
                             ? 2 * std::tan(0.5f * camera_.vertical_extent) * distance_
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
    distance_ = std::clamp(distance_ * scale, 1e-5f * size_, 1e3f * size_);
    go_to(center - camera_.forward() * distance_);
}

void CameraController::fly(FlyInput const& input, double seconds) {
    if (!input.moving()) {
        return;
    }
    float const speed = reach_ / 8 * (input.fast ? fast_factor : 1);
    Vec3 const direction = glm::normalize(input.direction);
    go_to(camera_.position + camera_.orientation * direction * (speed * static_cast<float>(seconds)));
}

} // namespace framelet
