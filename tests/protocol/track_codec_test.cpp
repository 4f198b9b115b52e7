// Tracks to bytes and back: what is lost, what it takes, what is refused.
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <gtest/gtest.h>

#include "common/error.h"
#include "protocol/codec/geometry/track_codec.h"

namespace framelet {
namespace {

using Tracks = std::vector<BodyTrack>;

struct Decoded {
    Tracks tracks;
    std::optional<BodyTrack> camera_track;
};

Decoded decoded(std::vector<std::uint8_t> const& bytes) {
    Decoded result;
    decode_tracks(bytes, result.tracks, result.camera_track);
    return result;
}

Decoded through(Tracks const& tracks, std::optional<BodyTrack> const& camera_track = {}) {
    return decoded(encode_tracks(tracks, camera_track));
}

/// Track of a wheel of a car that drives a curve.
BodyTrack wheel(BodyNumber body, std::size_t keys) {
    BodyTrack track{body, 120, {}};
    for (std::size_t k = 0; k < keys; ++k) {
        float const t = static_cast<float>(k) / body_keys_per_second;
        Quat const turned = glm::angleAxis(20 * t, Vec3(1, 0, 0));
        track.keys.push_back({{40 + 8 * t, 0.3f, 3 * std::sin(0.5f * t)}, turned, Vec3(1.5f)});
    }
    return track;
}

float distance(Quat const& a, Quat const& b) {
    Quat const difference = glm::dot(a, b) < 0 ? a + b : a - b;
    return glm::length(difference);
}

TEST(TrackCodec, WhatStaysIsExact) {
    BodyPose const pose{{1e-30f, -7.1234567f, 3e30f}, glm::normalize(Quat(0.1f, 0.2f, -0.3f, 0.4f)), {1, 0, -2}};
    Tracks const tracks{{3, -5, {pose}}, {70, std::int64_t{1} << 62, std::vector<BodyPose>(max_track_keys, pose)}};
    Decoded const result = through(tracks, BodyTrack{1, 9, {pose, pose}});
    EXPECT_EQ(result.tracks, tracks);
    ASSERT_TRUE(result.camera_track);
    EXPECT_EQ(*result.camera_track, (BodyTrack{1, 9, {pose, pose}}));
    EXPECT_FALSE(through({}).camera_track);
}

TEST(TrackCodec, WhatMovesIsRounded) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int i = 0; i < 2000; ++i) {
        BodyTrack track{9, i, {}};
        float const size = std::ldexp(1.0f, static_cast<int>(60 * unit(generator)));
        float largest = 0, largest_scale = 0;
        for (int k = 0; k < 20; ++k) {
            BodyPose pose;
            for (int axis = 0; axis < 3; ++axis) {
                pose.translation[axis] = size * unit(generator);
                pose.scale[axis] = unit(generator);
                largest = std::max(largest, std::abs(pose.translation[axis]));
                largest_scale = std::max(largest_scale, std::abs(pose.scale[axis]));
            }
            Quat const any(unit(generator), unit(generator), unit(generator), 1.1f + unit(generator));
            pose.rotation = glm::normalize(any);
            track.keys.push_back(pose);
        }
        Decoded const result = through({track});
        ASSERT_EQ(result.tracks.size(), 1u);
        ASSERT_EQ(result.tracks[0].keys.size(), track.keys.size());
        for (std::size_t k = 0; k < track.keys.size(); ++k) {
            BodyPose const& is = result.tracks[0].keys[k];
            BodyPose const& was = track.keys[k];
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_LE(std::abs(is.translation[axis] - was.translation[axis]), std::ldexp(largest, -20));
                EXPECT_LE(std::abs(is.scale[axis] - was.scale[axis]), std::ldexp(largest_scale, -20));
            }
            EXPECT_LE(distance(is.rotation, was.rotation), std::ldexp(1.0f, -16));
        }
        EXPECT_EQ(through(through(result.tracks).tracks).tracks, through(result.tracks).tracks) << "settles";
    }
}

TEST(TrackCodec, TheCameraIsExact) {
    BodyTrack const camera = wheel(2, 100);
    Decoded const result = through({wheel(3, 100)}, camera);
    ASSERT_TRUE(result.camera_track);
    ASSERT_EQ(result.camera_track->keys.size(), camera.keys.size());
    for (std::size_t k = 0; k < camera.keys.size(); ++k) {
        BodyPose const& is = result.camera_track->keys[k];
        BodyPose const& was = camera.keys[k];
        EXPECT_EQ(is.translation, was.translation);
        EXPECT_EQ(distance(is.rotation, was.rotation), 0) << "its sign says nothing";
    }
}

TEST(TrackCodec, SteadyMotionTakesFewBytes) {
    std::size_t const keys = 60;
    std::size_t const bytes = encode_tracks(Tracks{wheel(3, keys)}, {}).size();
    EXPECT_LE(bytes, 12 * keys) << "28 as they are";
}

TEST(TrackCodec, ExtremesAreKept) {
    float const largest = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();
    for (float const size : {largest, least, 1.0f}) {
        BodyTrack track{9, 0, {BodyPose{}, BodyPose{}, BodyPose{}}};
        track.keys[0].translation = Vec3(size, -size, 0);
        track.keys[1].translation = Vec3(-size, size, 0);
        Decoded const result = through({track});
        EXPECT_NEAR(result.tracks[0].keys[0].translation.x / size, 1, size < 1 ? 1 : 1e-6);
        EXPECT_NEAR(result.tracks[0].keys[1].translation.x / size, -1, size < 1 ? 1 : 1e-6);
    }
}

TEST(TrackCodec, BytesThatAreNotTracksAreRefused) {
    Tracks const tracks{wheel(3, 4), wheel(4, 1)};
    std::vector<std::uint8_t> const good = encode_tracks(tracks, wheel(1, 3));
    for (std::size_t size = 0; size < good.size(); ++size) {
        std::vector<std::uint8_t> const part(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
        if (part != encode_tracks(tracks, {})) { // else the part is a whole, the tracks without the camera's
            EXPECT_THROW(decoded(part), ProtocolError) << size;
        }
    }
    std::vector<std::uint8_t> more = good;
    more.push_back(0);
    EXPECT_THROW(decoded(more), ProtocolError);
    EXPECT_THROW(decoded(std::vector<std::uint8_t>(20, 0xff)), ProtocolError);
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (int bit = 0; bit < 8; ++bit) {
            std::vector<std::uint8_t> bad = good;
            bad[i] = static_cast<std::uint8_t>(bad[i] ^ 1 << bit);
            try {
                Decoded const result = decoded(bad);
                encode_tracks(result.tracks, result.camera_track); // what was taken can be sent again
            } catch (ProtocolError const&) {
            }
        }
    }
}

/// The bytes of one track that stays, with one number of its pose changed.
std::vector<std::uint8_t> with_number(std::size_t index, float number) {
    constexpr std::size_t head = 4; // one track, its body, first key, one key
    std::vector<std::uint8_t> bytes = encode_tracks(Tracks{{3, 0, {BodyPose{}}}}, {});
    std::size_t const member = index < 3 ? 0 : index < 7 ? 1 : 2;
    std::memcpy(&bytes[head + member + 1 + 4 * index], &number, sizeof number);
    return bytes;
}

TEST(TrackCodec, RangesAreThoseOfTheProtocol) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    for (std::size_t index = 0; index < 10; ++index) {
        EXPECT_THROW(decoded(with_number(index, nan)), ProtocolError) << index;
        EXPECT_THROW(decoded(with_number(index, infinity)), ProtocolError) << index;
        if (index == 6) { // the rotation is nearly none
            EXPECT_THROW(decoded(with_number(index, 0.25f)), ProtocolError);
        } else {
            EXPECT_NO_THROW(decoded(with_number(index, 0.25f))) << index;
        }
    }
}

TEST(TrackCodecDeathTest, NumbersOfTracksAndKeysAreBounded) {
    EXPECT_NO_THROW(through({{3, 0, std::vector<BodyPose>(max_track_keys)}}));
    auto const refused = [](Tracks const& tracks) { EXPECT_DEATH(encode_tracks(tracks, {}), "check failed"); };
    refused({{3, 0, std::vector<BodyPose>(max_track_keys + 1)}});
    refused({{3, 0, {}}});
    refused({{static_body, 0, {BodyPose{}}}});
    refused({{3, 0, {BodyPose{}}}, {3, 0, {BodyPose{}}}});
    refused({{3, (std::int64_t{1} << 62) + 1, {BodyPose{}}}});
    Tracks many(max_batch_tracks, {1, 0, {BodyPose{}}});
    for (std::size_t i = 0; i < many.size(); ++i) {
        many[i].body = static_cast<BodyNumber>(i + 1);
    }
    EXPECT_EQ(through(many).tracks, many);
    std::vector<std::uint8_t> bytes = encode_tracks(many, {});
    many.push_back({5000, 0, {BodyPose{}}});
    refused(many);
    bytes[0] = static_cast<std::uint8_t>(bytes[0] + 1); // one more, which would be the camera's
    EXPECT_THROW(decoded(bytes), ProtocolError);
    many.resize(max_batch_keys / max_track_keys + 1);
    for (BodyTrack& track : many) {
        track.keys.resize(max_track_keys);
    }
    refused(many);
}

} // namespace
} // namespace framelet
