#include "common/framelet/body_motion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

namespace framelet {

namespace {

/// Position of a time among the keys, in keys from the first one on, clamped to where poses still change.
double key_at(BodyTrack const& track, SceneTime time) {
    auto const last = static_cast<double>(track.keys.size() - 1);
    return std::clamp(time * body_keys_per_second - static_cast<double>(track.first_key), 0.0,
                      last + max_pose_extrapolation_seconds * body_keys_per_second);
}

/// The map from body to world of a pose.
Motion placement(BodyPose const& pose) {
    glm::dmat3 linear = glm::mat3_cast(glm::normalize(glm::dquat(pose.rotation)));
    for (int axis = 0; axis < 3; ++axis) {
        linear[axis] *= static_cast<double>(pose.scale[axis]);
    }
    return {linear, glm::dvec3(pose.translation)};
}

/// The rotation of a body from one key to the next about a time; none where there are not two keys.
glm::dquat turn_at(BodyTrack const& track, SceneTime time) {
    if (track.keys.size() < 2) {
        return glm::identity<glm::dquat>();
    }
    auto const index = std::min(static_cast<std::size_t>(key_at(track, time)), track.keys.size() - 2);
    glm::dquat const turn =
        glm::dquat(track.keys[index + 1].rotation) * glm::dquat(glm::conjugate(track.keys[index].rotation));
    return turn.w < 0 ? -turn : turn;
}

/// The rotation that takes a body's axle from where it points at `from` to where it points at `to`; nothing where the
/// body does not spin at both times.
std::optional<glm::dquat> turn_of_axle(BodyTrack const& track, SceneTime from, SceneTime to) {
    glm::dquat const before = turn_at(track, from);
    glm::dquat const after = turn_at(track, to);
    if (!(std::min(glm::angle(before), glm::angle(after)) >= least_spin)) {
        return std::nullopt;
    }
    glm::dvec3 const axle = glm::axis(before);
    double const cosine = glm::dot(axle, glm::axis(after));
    if (!(cosine >= 0)) { // it spins the other way by then, or its poses are none
        return std::nullopt;
    }
    return glm::normalize(glm::dquat(1 + cosine, glm::cross(axle, glm::axis(after))));
}

bool is_finite(Motion const& motion) {
    double sum = motion.offset.x + motion.offset.y + motion.offset.z;
    for (int column = 0; column < 3; ++column) {
        sum += motion.linear[column].x + motion.linear[column].y + motion.linear[column].z;
    }
    return std::isfinite(sum);
}

} // namespace

BodyPose pose_at(BodyTrack const& track, SceneTime time) {
    if (track.keys.empty()) {
        return {};
    }
    auto const last = static_cast<double>(track.keys.size() - 1);
    double const key = key_at(track, time);
    double const before = std::floor(std::min(key, std::max(last - 1, 0.0)));
    auto const index = static_cast<std::size_t>(before);
    BodyPose const& a = track.keys[index];
    BodyPose const& b = track.keys[std::min(index + 1, track.keys.size() - 1)];
    if (a == b || key == before) {
        return a;
    }
    auto const weight = static_cast<float>(key - before);
    BodyPose out;
    out.translation = a.translation + weight * (b.translation - a.translation);
    out.rotation = glm::normalize(glm::slerp(a.rotation, b.rotation, weight));
    out.scale = a.scale + weight * (b.scale - a.scale);
    return out;
}

Motion motion_between(BodyTrack const& track, SceneTime from, SceneTime to) {
    BodyPose const before = pose_at(track, from);
    BodyPose after = pose_at(track, to);
    if (before == after) {
        return {};
    }
    if (before.translation != after.translation) { // what spins in place would else seem to stand
        if (auto const turn = turn_of_axle(track, from, to)) {
            after.rotation = glm::quat(*turn * glm::dquat(before.rotation));
        }
    }
    Motion const source = placement(before);
    Motion const target = placement(after);
    Motion out;
    out.linear = target.linear * glm::inverse(source.linear);
    out.offset = target.offset - out.linear * source.offset;
    return is_finite(out) ? out : Motion{};
}

std::size_t BodyMotions::kept_keys() const {
    return std::min(kept_track_keys, most_kept_keys / std::bit_ceil(std::max<std::size_t>(tracks_.size(), 1)));
}

void BodyMotions::extend(BodyTrack const& track) {
    std::size_t const kept_before = kept_keys();
    BodyTrack& known = tracks_[track.body];
    known.body = track.body;
    if (kept_keys() < kept_before) {
        drop_surplus();
    }
    auto const end = known.first_key + static_cast<std::int64_t>(known.keys.size());
    if (track.first_key >= known.first_key && track.first_key <= end) {
        known.keys.resize(static_cast<std::size_t>(track.first_key - known.first_key));
    } else {
        known.keys.clear();
        known.first_key = track.first_key;
    }
    // Nothing is taken that would not be kept: memory once taken for the keys of a body is not given back.
    std::size_t const all = known.keys.size() + track.keys.size();
    std::size_t const surplus = all - std::min(all, kept_keys());
    auto const of_known = static_cast<std::ptrdiff_t>(std::min(surplus, known.keys.size()));
    auto const of_new = static_cast<std::ptrdiff_t>(surplus) - of_known;
    known.keys.erase(known.keys.begin(), known.keys.begin() + of_known);
    known.keys.insert(known.keys.end(), track.keys.begin() + of_new, track.keys.end());
    known.first_key += static_cast<std::int64_t>(surplus);
}

void BodyMotions::drop_surplus() {
    for (auto& [body, track] : tracks_) {
        std::size_t const surplus = track.keys.size() - std::min(track.keys.size(), kept_keys());
        track.keys.erase(track.keys.begin(), track.keys.begin() + static_cast<std::ptrdiff_t>(surplus));
        track.keys.shrink_to_fit();
        track.first_key += static_cast<std::int64_t>(surplus);
    }
}

BodyTrack const* BodyMotions::find(BodyNumber body) const {
    auto const found = tracks_.find(body);
    return found == tracks_.end() ? nullptr : &found->second;
}

Motion BodyMotions::between(BodyNumber body, SceneTime from, SceneTime to) const {
    BodyTrack const* const track = find(body);
    return track == nullptr ? Motion{} : motion_between(*track, from, to);
}

bool BodyMotions::rests(BodyNumber body, SceneTime from, SceneTime to) const {
    BodyTrack const* const track = find(body);
    if (track == nullptr || track->keys.size() < 2) {
        return true;
    }
    if (!knows_rest_) {
        return false;
    }
    std::size_t const last = track->keys.size() - 1;
    // After the last key a body goes on as between the last two.
    auto const first_key = std::min(static_cast<std::size_t>(key_at(*track, from)), last - 1);
    auto const end_key = std::min(static_cast<std::size_t>(std::ceil(key_at(*track, to))), last);
    auto const keys = std::span(track->keys).subspan(first_key, end_key - first_key + 1);
    return std::ranges::all_of(keys, [&](BodyPose const& pose) { return pose == keys.front(); });
}

void BodyMotions::jump_at(SceneTime time) {
    if (jumps_[1] != time) {
        jumps_ = {jumps_[1], time};
    }
}

TimeSpan BodyMotions::between_jumps(SceneTime time) const {
    TimeSpan span;
    for (SceneTime const jump : jumps_) {
        span.first = jump <= time ? std::max(span.first, jump) : span.first;
        span.last = jump > time ? std::min(span.last, std::nextafter(jump, time)) : span.last;
    }
    return span;
}

bool is_at_rest(FrameletShape const& shape, SceneTime scene_time, BodyMotions const& motions) {
    auto const rests = [&](auto const& one) {
        return !one.drift.any() && (one.body == static_body || motions.rests(one.body, scene_time - resting_seconds,
                                                                             scene_time + resting_seconds));
    };
    return std::all_of(shape.layers.begin(), shape.layers.begin() + shape.layer_count, rests) &&
           std::ranges::all_of(shape.outliers, rests);
}

} // namespace framelet
