#include <algorithm>
#include <array>

#include <glm/geometric.hpp>

#include "common/error.h"
#include "protocol/message_wire.h"

namespace framelet {
namespace {

constexpr char const* too_many_keys = "the tracks of a batch have more than 131072 keys";
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

} // namespace

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

namespace {

using Floats = flatbuffers::Vector<float>;

std::array<float, 3> numbers_of(Vec3 const& v) {
    return {v.x, v.y, v.z};
}

std::array<float, 4> numbers_of(Quat const& q) {
    return {q.x, q.y, q.z, q.w};
}

void assign(Vec3& v, float const* from) {
    v = {from[0], from[1], from[2]};
}

void assign(Quat& q, float const* from) {
    q = Quat(from[3], from[0], from[1], from[2]);
}

/// The numbers of one member of all keys; once where it stays as it is.
template <typename Member>
Offset<Floats> write(Builder& builder, std::vector<BodyPose> const& keys, Member BodyPose::*member) {
    bool const stays = std::ranges::all_of(keys, [&](BodyPose const& key) { return key.*member == keys[0].*member; });
    std::size_t const count = stays ? std::min<std::size_t>(keys.size(), 1) : keys.size();
    float* out = nullptr;
    auto const written = builder.CreateUninitializedVector(count * numbers_of(Member()).size(), &out);
    for (std::size_t key = 0; key < count; ++key) {
        out = std::ranges::copy(numbers_of(keys[key].*member), out).out;
    }
    return written;
}

template <typename Member>
void read(Floats const& wire, Member BodyPose::*member, std::vector<BodyPose>& keys) {
    std::size_t const numbers = numbers_of(Member()).size();
    bool const stays = wire.size() == numbers;
    if (!stays && wire.size() != numbers * keys.size()) {
        throw ProtocolError("a track's numbers are not those of its keys");
    }
    for (std::size_t key = 0; key < keys.size(); ++key) {
        assign(keys[key].*member, wire.data() + (stays ? 0 : key * numbers));
    }
}

} // namespace

Offset<wire::BodyTrack> write(Builder& builder, BodyTrack const& value) {
    auto const translations = write(builder, value.keys, &BodyPose::translation);
    auto const rotations = write(builder, value.keys, &BodyPose::rotation);
    auto const scales = write(builder, value.keys, &BodyPose::scale);
    return wire::CreateBodyTrack(builder, value.body, value.first_key, static_cast<std::uint16_t>(value.keys.size()),
                                 translations, rotations, scales);
}

BodyTrack read(wire::BodyTrack const& wire) {
    BodyTrack value{wire.body(), wire.first_key(), {}};
    value.keys.resize(wire.keys());
    read(*wire.translations(), &BodyPose::translation, value.keys);
    read(*wire.rotations(), &BodyPose::rotation, value.keys);
    read(*wire.scales(), &BodyPose::scale, value.keys);
    return value;
}

Offset<TrackList> write(Builder& builder, std::vector<BodyTrack> const& value) {
    std::vector<Offset<wire::BodyTrack>> tracks;
    for (BodyTrack const& track : value) {
        tracks.push_back(write(builder, track));
    }
    return builder.CreateVector(tracks);
}

std::vector<BodyTrack> read(TrackList const& wire) {
    if (wire.size() > max_batch_tracks) {
        throw ProtocolError("a batch has more than 4096 tracks");
    }
    std::size_t keys = 0;
    for (wire::BodyTrack const* const track : wire) {
        keys += track->keys();
    }
    if (keys > max_batch_keys) {
        throw ProtocolError(too_many_keys);
    }
    std::vector<BodyTrack> value;
    value.reserve(wire.size());
    for (wire::BodyTrack const* const track : wire) {
        value.push_back(read(*track));
    }
    return value;
}

char const* problem(std::vector<BodyTrack> const& value) {
    if (value.size() > max_batch_tracks) {
        return "a batch has more than 4096 tracks";
    }
    std::vector<BodyNumber> bodies;
    std::size_t keys = 0;
    for (BodyTrack const& track : value) {
        if (char const* const fault = problem(track)) {
            return fault;
        }
        bodies.push_back(track.body);
        keys += track.keys.size();
    }
    if (keys > max_batch_keys) {
        return too_many_keys;
    }
    std::ranges::sort(bodies);
    return std::ranges::adjacent_find(bodies) == bodies.end() ? nullptr : "a batch has two tracks of one body";
}

} // namespace framelet
