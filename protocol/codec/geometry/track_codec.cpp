#include "protocol/codec/geometry/track_codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include <glm/geometric.hpp>

#include "common/error.h"
#include "protocol/codec/entropy/byte_cursor.h"
#include "protocol/codec/entropy/zigzag.h"

namespace framelet {
namespace {

using Content = std::vector<std::uint8_t>;
/// Numbers of a key: translation (x y z), rotation (x y z w) and scale (x y z).
constexpr std::size_t key_numbers = 10;
using KeyNumbers = std::array<float, key_numbers>;
/// Numbers of a key, `first` to `end`, that are rounded alike, and stay as they are together.
struct Member {
    std::size_t first, end;
};
constexpr std::array<Member, 3> members{{{0, 3}, {3, 7}, {7, 10}}};
constexpr std::size_t rotation = 1;

/// Bias of units: a number of a member on the wire stands for so many times 2^(unit - unit_zero).
constexpr int unit_zero = 160;
constexpr int relative_bits = 20, rotation_bits = 16;
/// Values in the place of a unit: where the member stays as it is, its numbers follow once, as floats; where it is
/// exact, those of all keys do.
constexpr std::uint8_t stays = 0, exact = 1;
/// Rounding of the members that change.
enum class Rounding : bool { none, fine };
constexpr std::int64_t farthest_key = std::int64_t{1} << 62;

KeyNumbers numbers_of(BodyPose const& pose) {
    Quat const& q = pose.rotation;
    return {pose.translation.x, pose.translation.y, pose.translation.z, q.x, q.y, q.z, q.w,
            pose.scale.x,       pose.scale.y,       pose.scale.z};
}

BodyPose pose_of(KeyNumbers const& n) {
    return {{n[0], n[1], n[2]}, Quat(n[6], n[3], n[4], n[5]), {n[7], n[8], n[9]}};
}

bool is_usable(KeyNumbers const& n) {
    float const squared = n[3] * n[3] + n[4] * n[4] + n[5] * n[5] + n[6] * n[6];
    return std::ranges::all_of(n, [](float x) { return std::isfinite(x); }) && squared >= 0.25f && squared <= 4;
}

/// Names what is wrong with a track; nullptr: nothing.
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
    bool const usable = std::ranges::all_of(track.keys, [](auto const& key) { return is_usable(numbers_of(key)); });
    return usable ? nullptr : "a track has a pose that is not a usable one";
}

char const* problem(std::span<BodyTrack const> tracks) {
    if (tracks.size() > max_batch_tracks) {
        return "a batch has more than 4096 tracks";
    }
    std::vector<BodyNumber> bodies;
    std::size_t keys = 0;
    for (BodyTrack const& track : tracks) {
        bodies.push_back(track.body);
        keys += track.keys.size();
    }
    if (keys > max_batch_keys) {
        return "the tracks of a batch have more than 131072 keys";
    }
    std::ranges::sort(bodies);
    return std::ranges::adjacent_find(bodies) == bodies.end() ? nullptr : "a batch has two tracks of one body";
}

void put(Content& out, std::uint64_t number) {
    for (; number >= 0x80; number >>= 7) {
        out.push_back(static_cast<std::uint8_t>(number | 0x80));
    }
    out.push_back(static_cast<std::uint8_t>(number));
}

std::uint64_t take(ByteCursor& bytes) {
    std::uint64_t number = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
        std::uint8_t const byte = bytes.take(1)[0];
        number |= std::uint64_t{byte & 0x7fu} << shift;
        if (byte < 0x80) {
            return number;
        }
    }
    throw ProtocolError("a number of a track has more than ten bytes");
}

void put_float(Content& out, float number) {
    std::array<std::uint8_t, 4> bytes;
    std::memcpy(bytes.data(), &number, sizeof number);
    out.insert(out.end(), bytes.begin(), bytes.end());
}

float take_float(ByteCursor& bytes) {
    float number = 0;
    std::memcpy(&number, bytes.take(sizeof number).data(), sizeof number);
    return number;
}

/// Turns a number into units of 2^(unit - unit_zero), and back.
std::int64_t rounded(float number, int unit) {
    return std::llround(std::ldexp(static_cast<double>(number), unit_zero - unit));
}
float number_of(std::int64_t rounded, int unit) {
    double const number = std::ldexp(static_cast<double>(rounded), unit - unit_zero);
    if (std::abs(number) > double{std::numeric_limits<float>::max()}) {
        throw ProtocolError("a track has a pose that is not a usable one");
    }
    return static_cast<float>(number);
}

/// The unit in which a member of all keys is rounded, by its largest magnitude.
std::uint8_t unit_of(std::span<KeyNumbers const> keys, Member member) {
    float largest = 0;
    for (KeyNumbers const& key : keys) {
        for (std::size_t i = member.first; i < member.end; ++i) {
            largest = std::max(largest, std::abs(key[i]));
        }
    }
    int const exponent = largest > 0 ? std::ilogb(largest) + 1 : 0;
    return static_cast<std::uint8_t>(std::clamp(exponent - relative_bits + unit_zero, exact + 1, 255));
}

/// Puts second differences, which are nearly all 0 where something moves steadily. They wrap.
void put_moving(Content& out, std::span<KeyNumbers const> keys, Member member, int unit) {
    for (std::size_t i = member.first; i < member.end; ++i) {
        std::int64_t before = 0, step = 0;
        for (KeyNumbers const& key : keys) {
            std::int64_t const now = rounded(key[i], unit);
            put(out, zigzag(now - before - step));
            step = now - before;
            before = now;
        }
    }
}

void take_moving(ByteCursor& bytes, std::span<KeyNumbers> keys, Member member, int unit) {
    for (std::size_t i = member.first; i < member.end; ++i) {
        std::uint64_t now = 0, step = 0;
        for (KeyNumbers& key : keys) {
            step += static_cast<std::uint64_t>(from_zigzag(take(bytes)));
            now += step;
            key[i] = number_of(static_cast<std::int64_t>(now), unit);
        }
    }
}

/// Numbers of all keys. A quaternion and its negative are the same rotation: the one is taken that is near the key
/// before.
std::vector<KeyNumbers> numbers_of(BodyTrack const& track) {
    std::vector<KeyNumbers> keys;
    Quat before = track.keys.front().rotation;
    for (BodyPose pose : track.keys) {
        pose.rotation = glm::dot(before, pose.rotation) < 0 ? -pose.rotation : pose.rotation;
        before = pose.rotation;
        keys.push_back(numbers_of(pose));
    }
    return keys;
}

void put(Content& out, BodyTrack const& track, Rounding rounding) {
    FRAMELET_CHECK(problem(track) == nullptr);
    put(out, track.body);
    put(out, zigzag(track.first_key));
    put(out, track.keys.size());
    std::vector<KeyNumbers> const keys = numbers_of(track);
    for (std::size_t m = 0; m < members.size(); ++m) {
        auto const [first, end] = members[m];
        bool const is_constant = std::ranges::all_of(keys, [&, first = first, end = end](KeyNumbers const& key) {
            return std::equal(&key[first], key.data() + end, &keys[0][first]);
        });
        if (is_constant || rounding == Rounding::none) {
            out.push_back(is_constant ? stays : exact);
            for (std::size_t i = first; i < end; ++i) {
                std::for_each(keys.begin(), is_constant ? keys.begin() + 1 : keys.end(),
                              [&](KeyNumbers const& key) { put_float(out, key[i]); });
            }
        } else {
            std::uint8_t const unit = m == rotation ? unit_zero - rotation_bits : unit_of(keys, members[m]);
            out.push_back(unit);
            put_moving(out, keys, members[m], unit);
        }
    }
}

BodyTrack take_track(ByteCursor& bytes) {
    std::uint64_t const body = take(bytes);
    std::int64_t const first_key = from_zigzag(take(bytes));
    std::uint64_t const count = take(bytes);
    if (body > std::uint64_t{std::numeric_limits<BodyNumber>::max()} || count > max_track_keys) {
        throw ProtocolError("a track has too many keys or is of an unknown body");
    }
    std::vector<KeyNumbers> keys(static_cast<std::size_t>(count));
    for (Member const& member : members) {
        std::uint8_t const unit = bytes.take(1)[0];
        if (unit > exact) {
            take_moving(bytes, keys, member, unit);
            continue;
        }
        for (std::size_t i = member.first; i < member.end; ++i) {
            float number = 0;
            for (std::size_t k = 0; k < keys.size(); ++k) {
                number = k == 0 || unit == exact ? take_float(bytes) : number;
                keys[k][i] = number;
            }
        }
    }
    BodyTrack track{static_cast<BodyNumber>(body), first_key, {}};
    std::ranges::transform(keys, std::back_inserter(track.keys), pose_of);
    if (char const* const fault = problem(track)) {
        throw ProtocolError(fault);
    }
    return track;
}

} // namespace

Content encode_tracks(std::span<BodyTrack const> tracks, std::optional<BodyTrack> const& camera_track) {
    FRAMELET_CHECK(problem(tracks) == nullptr);
    Content out;
    put(out, tracks.size());
    std::ranges::for_each(tracks, [&](BodyTrack const& track) { put(out, track, Rounding::fine); });
    if (camera_track) {
        put(out, *camera_track, Rounding::none);
    }
    return out;
}

void decode_tracks(std::span<std::uint8_t const> bytes, std::vector<BodyTrack>& tracks,
                   std::optional<BodyTrack>& camera_track) {
    tracks.clear();
    camera_track.reset();
    ByteCursor cursor{bytes.data(), bytes.data() + bytes.size()};
    std::uint64_t const count = take(cursor);
    std::size_t keys = 0;
    for (std::uint64_t i = 0; i < count && tracks.size() <= max_batch_tracks && keys <= max_batch_keys; ++i) {
        keys += tracks.emplace_back(take_track(cursor)).keys.size();
    }
    if (char const* const fault = problem(tracks)) {
        throw ProtocolError(fault);
    }
    if (cursor.left() > 0) {
        camera_track = take_track(cursor);
    }
    if (cursor.left() > 0) {
        throw ProtocolError("something follows the tracks of a batch");
    }
}

} // namespace framelet
