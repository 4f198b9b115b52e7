// Encodes tracks of bodies and of the scene's camera to bytes and back, before compression. PROTOCOL.md has the layout.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/framelet/body_track.h"

namespace framelet {

/// The largest number of keys of one track.
inline constexpr std::size_t max_track_keys = 1024;

/// The largest number of bytes of the tracks of one batch: each key with ten numbers of five bytes.
inline constexpr std::size_t most_track_bytes = 64 * (max_batch_tracks + 2) + 50 * (max_batch_keys + max_track_keys);

/// Encodes tracks. Members of bodies' poses that change are rounded: translations and scales to 2^-20 of the largest
/// one of their track, rotations to 2^-16. The camera's are not: framelets show exactly what it sees only from where
/// they were rendered. Every number must be inside its range of PROTOCOL.md (FRAMELET_CHECK).
std::vector<std::uint8_t> encode_tracks(std::span<BodyTrack const> tracks,
                                        std::optional<BodyTrack> const& camera_track);

/// Decodes tracks, which replace what the two arguments held. ProtocolError for bytes that are not exactly such tracks,
/// each number inside its range.
void decode_tracks(std::span<std::uint8_t const> bytes, std::vector<BodyTrack>& tracks,
                   std::optional<BodyTrack>& camera_track);

} // namespace framelet
