// Where bodies are at any scene time, from their tracks, and how each has moved between two times.
#pragma once

#include <array>
#include <cmath>

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/vector_double3.hpp>
#include <unordered_map>

#include "common/framelet/body_track.h"
#include "common/framelet/framelet.h"
#include "common/framelet/framelet_shape.h"

namespace framelet {

/// How much later than its last key a body is moved on as it moved between the last two. Beyond that, and before the
/// first key, it rests.
inline constexpr SceneTime max_pose_extrapolation_seconds = 0.1;

/// Keys that a viewer keeps of a body: half a minute.
inline constexpr std::size_t kept_track_keys = 30 * body_keys_per_second;
/// And of all bodies together, whoever says that there are so many: where they are more than a thousand, fewer of each.
inline constexpr std::size_t most_kept_keys = std::size_t{1} << 21;

/// World at one time to world at another: x -> linear * x + offset, metres.
struct Motion {
    glm::dmat3 linear{1};
    glm::dvec3 offset{0};

    bool operator==(Motion const&) const = default;
};

/// Translation and scale interpolated linearly between the keys, rotation along the shorter arc. No keys: at rest in
/// the origin.
BodyPose pose_at(BodyTrack const& track, SceneTime time);

/// The motion that takes a point of the body from where it is at `from` to where it is at `to`. Exactly none where
/// the poses are equal; none where a scale of 0 leaves it undefined.
Motion motion_between(BodyTrack const& track, SceneTime from, SceneTime to);

/// The tracks of all bodies that a viewer knows.
class BodyMotions {
public:
    BodyMotions() = default;
    /// `knows_rest`: else whatever has a track is taken to move, always.
    explicit BodyMotions(bool knows_rest) : knows_rest_(knows_rest) {}

    /// Takes in keys of a body. They replace those of the same times and later; keys that neither overlap nor follow
    /// what is known replace all of it. Of each body the last `kept_keys` are kept.
    void extend(BodyTrack const& track);
    /// `kept_track_keys`, or what share each body has of `most_kept_keys`. It shrinks where bodies double in number, so
    /// that what is held is rarely gone through.
    std::size_t kept_keys() const;

    /// None for bodies that have no track, `static_body` among them.
    Motion between(BodyNumber body, SceneTime from, SceneTime to) const;
    /// True only where `between` is none for any two times from `from` to `to`.
    bool rests(BodyNumber body, SceneTime from, SceneTime to) const;
    /// Null where nothing is known of it.
    BodyTrack const* find(BodyNumber body) const;

    /// All may look otherwise from this scene time on: what was rendered before is out of date after it. Two such times
    /// are known, one of which may still be to come.
    void jump_at(SceneTime time);
    /// The latest one that is not after `time`; less than any time where there is none.
    SceneTime last_jump(SceneTime time) const;

private:
    void drop_surplus();

    bool knows_rest_ = true;
    std::unordered_map<BodyNumber, BodyTrack> tracks_;
    std::array<SceneTime, 2> jumps_{-INFINITY, -INFINITY}; ///< the older one first
};

/// What rests for so long before and after it was rendered, seconds of scene time, is held as what stands.
inline constexpr SceneTime resting_seconds = 0.2;

/// Whether nothing in it moves about the time when it was rendered: all that is on bodies rests, nothing deforms.
bool is_at_rest(FrameletShape const& shape, SceneTime scene_time, BodyMotions const& motions);

} // namespace framelet
