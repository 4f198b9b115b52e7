// Computes from tracks where bodies are at any scene time, and how each has moved between two times.
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

/// Seconds after its last key for which a body goes on moving as between its last two keys. Beyond that, and before the
/// first key, it rests.
inline constexpr SceneTime max_pose_extrapolation_seconds = 0.1;

/// Rotation from one key to the next, radians, from which on a body spins: 30 radians a second, which no eye follows.
inline constexpr double least_spin = 0.5;

/// Keys that a viewer keeps of a body: half a minute.
inline constexpr std::size_t kept_track_keys = 30 * body_keys_per_second;
/// Keys that a viewer keeps of all bodies together, however many a server says there are: of more than a thousand
/// bodies it keeps fewer keys each.
inline constexpr std::size_t most_kept_keys = std::size_t{1} << 21;

/// Maps the world at one time to the world at another: x -> linear * x + offset, metres.
struct Motion {
    glm::dmat3 linear{1};
    glm::dvec3 offset{0};

    bool operator==(Motion const&) const = default;
};

/// The pose of a body at a time: translation and scale are interpolated linearly between keys, rotation along the
/// shorter arc. A track without keys rests at the origin.
BodyPose pose_at(BodyTrack const& track, SceneTime time);

/// The motion that takes a point of the body from where it is at `from` to where it is at `to`. What spins as it goes,
/// as wheels do, only follows its axle: its samples would be carried behind what hides a part of it, and leave gaps
/// where they were, while others of its surface have come in their place. Exactly the identity where the poses are
/// equal; the identity, too, where a scale of 0 leaves it undefined.
Motion motion_between(BodyTrack const& track, SceneTime from, SceneTime to);

/// Scene times from `first` to `last`, both included, seconds; empty where `last` comes before `first`.
struct TimeSpan {
    SceneTime first = -INFINITY, last = INFINITY;

    bool contains(SceneTime time) const { return first <= time && time <= last; }
    bool operator==(TimeSpan const&) const = default;
};

/// The tracks of all bodies that a viewer knows.
class BodyMotions {
public:
    BodyMotions() = default;
    /// Where `knows_rest` is false, whatever has a track (of two keys or more) is taken to move, always.
    explicit BodyMotions(bool knows_rest) : knows_rest_(knows_rest) {}

    /// Takes in keys of a body. They replace those of the same times and later; keys that neither overlap nor follow
    /// what is known replace all of it. Of each body the last `kept_keys` are kept.
    void extend(BodyTrack const& track);
    /// Keys that are kept of each body: `kept_track_keys`, or each body's share of `most_kept_keys`. The share shrinks
    /// only where the number of bodies passes a power of two, so that what is held is rarely gone through.
    std::size_t kept_keys() const;

    /// The motion of a body between two times; the identity for bodies that have no track, `static_body` among them.
    Motion between(BodyNumber body, SceneTime from, SceneTime to) const;
    /// True only where `between` is the identity for any two times from `from` to `to`.
    bool rests(BodyNumber body, SceneTime from, SceneTime to) const;
    /// The track of a body; null where nothing is known of it.
    BodyTrack const* find(BodyNumber body) const;

    /// Notes a jump of the scene: all may look otherwise from this scene time on, and what was rendered before is out
    /// of date after it, and what was rendered after before it. The last two such times are known, one of which may
    /// still be to come.
    void jump_at(SceneTime time);
    /// The times between which there is no jump, `time` among them: from the latest jump that is not after it, until
    /// the earliest one that is.
    TimeSpan between_jumps(SceneTime time) const;

private:
    void drop_surplus();

    bool knows_rest_ = true;
    std::unordered_map<BodyNumber, BodyTrack> tracks_;
    std::array<SceneTime, 2> jumps_{-INFINITY, -INFINITY}; ///< the older one first
};

/// Seconds of scene time before and after its rendering for which something has to rest to be held with what stands.
inline constexpr SceneTime resting_seconds = 0.2;

/// True when nothing in a framelet moves about the time when it was rendered: the bodies in it rest, and no sample has
/// a velocity besides.
bool is_at_rest(FrameletShape const& shape, SceneTime scene_time, BodyMotions const& motions);

} // namespace framelet
