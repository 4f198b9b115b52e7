#include "server/stream/camera_forecast.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "common/error.h"

namespace framelet {
namespace {

constexpr double watched_seconds = 0.12;
/// Seconds; of cameras that come sooner after each other only the last one counts: there may be any number of them.
constexpr double least_seconds = 0.002;
/// A camera that has stayed for so long stands, seconds: longer than a slow display's frame.
constexpr double standing_seconds = 0.05;

/// The motion or turn a second (axis times angle) that both halves agree in: the later one, as far as the earlier one
/// was like it.
Vec3 agreed(Vec3 earlier, Vec3 later) {
    float const most = std::max(glm::dot(earlier, earlier), glm::dot(later, later));
    float const share = most > 0 ? std::clamp(glm::dot(earlier, later) / most, 0.0f, 1.0f) : 0.0f;
    return share * later;
}

/// Axis times angle, radians, that turns one orientation into the other, the short way.
Vec3 turn_between(Quat const& from, Quat const& to) {
    Quat turn = to * glm::conjugate(from);
    turn = turn.w < 0 ? -turn : turn;
    Vec3 const sine(turn.x, turn.y, turn.z);
    float const length = glm::length(sine);
    return length > 0 ? 2 * std::atan2(length, turn.w) / length * sine : Vec3(0);
}

Quat turned(Quat const& orientation, Vec3 turn) {
    float const angle = glm::length(turn);
    return angle > 0 ? glm::normalize(glm::angleAxis(angle, turn / angle) * orientation) : orientation;
}

} // namespace

void CameraForecast::add(Camera const& camera, double seconds) {
    std::erase_if(known_, [&](Known const& known) { return known.seconds < seconds - watched_seconds; });
    if (known_.size() > 1 && known_.back().seconds - known_[known_.size() - 2].seconds < least_seconds) {
        known_.pop_back();
    }
    known_.push_back({camera, seconds});
}

Camera CameraForecast::at(double now, double ahead) const {
    FRAMELET_CHECK(!known_.empty());
    Known const& last = known_.back();
    Known const& first = known_.front();
    double const middle_time = 0.5 * (first.seconds + last.seconds);
    Known const& middle = *std::ranges::min_element(
        known_, {}, [&](Known const& known) { return std::abs(known.seconds - middle_time); });
    bool const tells = first.seconds < middle.seconds && middle.seconds < last.seconds &&
                       last.seconds - first.seconds >= 0.5 * watched_seconds;
    if (!tells || now - last.seconds > standing_seconds || first.camera.projection != last.camera.projection) {
        return last.camera;
    }
    auto const early = static_cast<float>(middle.seconds - first.seconds);
    auto const late = static_cast<float>(last.seconds - middle.seconds);
    auto const time = static_cast<float>(now - last.seconds + ahead);
    Camera camera = last.camera;
    camera.position += time * agreed((middle.camera.position - first.camera.position) / early,
                                     (last.camera.position - middle.camera.position) / late);
    camera.orientation = turned(camera.orientation,
                                time * agreed(turn_between(first.camera.orientation, middle.camera.orientation) / early,
                                              turn_between(middle.camera.orientation, last.camera.orientation) / late));
    return within_bounds(camera);
}

} // namespace framelet
