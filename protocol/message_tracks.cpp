#include <algorithm>
#include <array>

#include <glm/geometric.hpp>

#include "common/error.h"
#include "protocol/message_wire.h"

namespace framelet {
namespace {

constexpr std::size_t key_floats = 10;
constexpr std::int64_t farthest_key = std::int64_t{1} << 62;

bool is_finite(Vec3 const& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Readers make the rotation one of unit length.
bool is_usable(BodyPose const& pose) {
    Quat const& q = pose.rotation;
    float const squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    return is_finite(pose.translation) && is_finite(pose.scale) && in_range(static_cast<double>(squared), 0.25, 4);
}

char const* problem(BodyTrack const& track) {
    if (track.body == static_body) {
        return "a track is of the body that never moves";
    }
    if (track.keys.empty() || track.keys.size() > max_track_keys) {
        return "the number of a track's keys is not within 1..1024";
    }
    if (track.first_key < -farthest_key || track.first_key > farthest_key) {
        return "a track's first key is not within -2^62..2^62";
    }
    return std::ranges::all_of(track.keys, is_usable) ? nullptr : "a track has a pose that is not a usable one";
}

} // namespace

Offset<TrackList> write(Builder& builder, std::vector<BodyTrack> const& value) {
    std::vector<Offset<wire::BodyTrack>> tracks;
    for (BodyTrack const& track : value) {
        float* out = nullptr;
        auto const keys = builder.CreateUninitializedVector(key_floats * track.keys.size(), &out);
        for (auto const& [t, q, s] : track.keys) {
            out = std::ranges::copy(std::array{t.x, t.y, t.z, q.x, q.y, q.z, q.w, s.x, s.y, s.z}, out).out;
        }
        tracks.push_back(wire::CreateBodyTrack(builder, track.body, track.first_key, keys));
    }
    return builder.CreateVector(tracks);
}

std::vector<BodyTrack> read(TrackList const& wire) {
    if (wire.size() > max_batch_tracks) {
        throw ProtocolError("a batch has more than 4096 tracks");
    }
    std::vector<BodyTrack> value;
    value.reserve(wire.size());
    for (wire::BodyTrack const* const track : wire) {
        std::size_t const floats = track->keys()->size();
        if (floats % key_floats != 0) {
            throw ProtocolError("a track's keys are not ten numbers each");
        }
        BodyTrack& out = value.emplace_back(BodyTrack{track->body(), track->first_key(), {}});
        out.keys.reserve(floats / key_floats);
        for (float const* k = track->keys()->data(); out.keys.size() < floats / key_floats; k += key_floats) {
            out.keys.push_back({{k[0], k[1], k[2]}, Quat(k[6], k[3], k[4], k[5]), {k[7], k[8], k[9]}});
        }
    }
    return value;
}

char const* problem(std::vector<BodyTrack> const& value) {
    if (value.size() > max_batch_tracks) {
        return "a batch has more than 4096 tracks";
    }
    std::vector<BodyNumber> bodies;
    for (BodyTrack const& track : value) {
        if (char const* const fault = problem(track)) {
            return fault;
        }
        bodies.push_back(track.body);
    }
    std::ranges::sort(bodies);
    return std::ranges::adjacent_find(bodies) == bodies.end() ? nullptr : "a batch has two tracks of one body";
}

} // namespace framelet
