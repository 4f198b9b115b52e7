// Messages: what the two programs say to each other, as values. PROTOCOL.md is the specification, framelet.fbs the
// schema.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/camera.h"
#include "common/clock_state.h"
#include "common/color.h"
#include "common/framelet/framelet.h"

namespace framelet {

using Bytes = std::vector<std::byte>;
using ByteView = std::span<std::byte const>;

inline constexpr std::uint16_t protocol_version = 7;

/// A ticket lets a viewer go on where its connection was cut: 128 random bits. All of them 0: none.
struct Ticket {
    std::uint64_t high = 0, low = 0;
    explicit operator bool() const { return (high | low) != 0; }
    /// Takes a time that does not depend on where they differ.
    bool operator==(Ticket const& other) const { return ((high ^ other.high) | (low ^ other.low)) == 0; }
};

// --- upstream

/// Bits for what a viewer can read; a server sends nothing else. `Hello::codings` is a sum of these; bits that a server
/// does not know mean nothing to it.
namespace coding {
inline constexpr std::uint32_t none = 0; ///< no batches: it only hears the scene's clock, and may set it
inline constexpr std::uint32_t exact_colour = 1; ///< every viewer can read it
inline constexpr std::uint32_t haar_colour = 2; ///< framelets with a QP
inline constexpr std::uint32_t predicted_colour = 8; ///< framelets predicted from those of earlier batches
inline constexpr std::uint32_t shapes_and_tracks = 64;
inline constexpr std::uint32_t all = exact_colour | haar_colour | shapes_and_tracks | predicted_colour; ///< known here
} // namespace coding

/// Who offers itself as a worker wants no pictures, but orders of paths. Scene and light as its own: what it answers is
/// of use where they are the server's.
struct WorkOffer {
    std::uint64_t scene = 0; ///< as `Welcome::scene_identity`
    std::uint64_t light = 0; ///< what paths bring there, with its program and on its processor; never 0
    std::uint16_t threads = 1;
    bool operator==(WorkOffer const&) const = default;
};

/// The first message of a connection.
struct Hello {
    std::uint16_t version = protocol_version;
    std::string token; ///< empty where the server asks for none
    std::uint32_t codings = coding::exact_colour;
    Ticket ticket{}; ///< that of the session before, to go on with it
    std::uint64_t last_batch = 0; ///< the newest of that session that the viewer has, with all before it; 0: none
    std::optional<WorkOffer> work{};
    bool operator==(Hello const&) const = default;
};

/// The viewer's newest camera. Numbers count up; an older one that arrives late is ignored.
struct CameraUpdate {
    NumberedView view;
    int scene_camera = -1; ///< >= 0: look through this camera of the scene instead (its animation included)
    bool operator==(CameraUpdate const&) const = default;
};

/// Settings of a viewer: how it wants its picture.
struct ViewerSettings {
    float exposure_ev = 0; ///< stops, added to the server's own exposure, [-16, 16]
    float bias = 0; ///< -1 (spatial fidelity) .. 1 (temporal)
    /// True where it moves samples to where they are seen later; false: it shows them where they were rendered, and has
    /// no use for shapes.
    bool reproject = true;
    /// Nobody sees its picture: it wants nothing until it says otherwise.
    bool paused = false;
    bool operator==(ViewerSettings const&) const = default;
};

/// Sets the shared scene clock. Only the fields named by `set` are taken.
struct ClockRequest {
    enum Field : std::uint8_t { time = 1, playing = 2, speed = 4 };
    std::uint8_t set = 0;
    ClockState state;
    bool operator==(ClockRequest const&) const = default;
};

/// A batch has been decoded.
struct Ack {
    std::uint64_t batch = 0;
    std::uint64_t received_us = 0; ///< viewer's steady clock, microseconds, when the batch's last byte had arrived
    std::uint32_t decode_us = 0; ///< microseconds from then until the batch was decoded
    bool operator==(Ack const&) const = default;
};

/// The viewer no longer holds these framelets, though nothing newer has come in their places.
struct Evicted {
    std::vector<SentTile> framelets; ///< those of a batch together; at most `max_evicted`
    bool operator==(Evicted const&) const = default;
};
/// The largest number of framelets of one message; more are several messages.
inline constexpr std::size_t max_evicted = 4096;

/// A worker's answer to an order.
struct PathAnswer {
    std::uint64_t number = 0; ///< of the order
    std::uint32_t took_us = 0; ///< microseconds of a processor
    std::vector<float> light; ///< of each tile, then of each place (PROTOCOL.md, *Workers*); empty: it was left out
    bool operator==(PathAnswer const&) const = default;
};

// --- downstream, and either direction

/// One path through each sample of a tile.
struct TilePath {
    Tile tile;
    std::uint32_t number = 0; ///< of the path, among those of a sample
    bool operator==(TilePath const&) const = default;
};
inline constexpr std::size_t max_order_tiles = 16; ///< so many that an answer is one message

/// Sixteen paths from a place of the light cache.
struct PlacePaths {
    std::uint32_t frame = 0; ///< 0: the world; else the number of a moving instance + 1
    Vec3 position{0}; ///< in the frame, metres
    Vec3 normal{0, 1, 0}; ///< in the frame, unit
    std::uint32_t seed = 0; ///< of their random numbers
    std::uint32_t first = 0; ///< number of the first, among those of the place
    float bright = 0; ///< luminance from which on what a path brings is kept apart
    bool operator==(PlacePaths const&) const = default;
};
inline constexpr std::size_t max_order_places = 512; ///< likewise

/// Paths of light that a worker is to trace: of tiles or of places, not of both.
struct PathOrder {
    std::uint64_t number = 0;
    std::uint64_t round = 0; ///< number of the first order of its round: older ones are of no use any more
    SceneTime scene_time = 0;
    NumberedView view; ///< of the tiles
    DisplayTransform display; ///< as which unlit surfaces keep their colours
    std::vector<TilePath> tiles;
    std::vector<PlacePaths> places;
    bool operator==(PathOrder const&) const = default;
};

struct SceneCameraInfo {
    std::string name;
    Camera camera; ///< pose at scene time 0
    bool operator==(SceneCameraInfo const&) const = default;
};

/// The answer to Hello: the session is open.
struct Welcome {
    std::uint16_t version = protocol_version;
    std::string server; ///< program and version
    std::string scene_name;
    Bounds scene_bounds;
    Camera start_camera; ///< what to look through until the user moves
    std::vector<SceneCameraInfo> cameras;
    double animation_duration = 0; ///< seconds; 0: nothing moves
    ClockState clock;
    std::uint64_t scene_identity = 0; ///< the same where it is the same scene, whatever the server; 0: not known
    bool controls = true; ///< whether this viewer's clock requests count
    Ticket ticket{}; ///< for the viewer's next Hello
    bool resumed = false; ///< the session before goes on: what the viewer holds of it stays, what it lacks comes again
    std::uint64_t evicted = 0; ///< how many messages Evicted have come, as in Status
    std::uint64_t scene_source = 0; ///< the same where it is the same file, whatever is in it by now; 0: not known
    glm::dvec3 scene_origin{0, 0, 0}; ///< where the scene's file has the point that is (0, 0, 0) here, metres
};

/// The encoding of a batch's samples, numbered as on the wire.
enum class SampleEncoding : std::uint8_t {
    exact = 1, ///< all samples without loss
    haar = 7, ///< each framelet with a QP of its own
    predicted = 8, ///< the same, but framelets may be predicted from the reference picture
};

/// The moment of a batch: its camera, its scene time and when it is shown; the fields are those of a Moment.
struct BatchMoment {
    NumberedView view;
    SceneTime scene_time = 0;
    SceneTime shown_from = 0;
    bool outdates = false;
    bool operator==(BatchMoment const&) const = default;
};

/// A batch as it travels: tiles in the clear, samples, shapes and tracks compressed by `batch_codec`.
struct EncodedBatch {
    std::uint64_t number = 0;
    std::optional<BatchMoment> moment = BatchMoment{}; ///< none: that of the batch before
    std::vector<Tile> tiles;
    Bytes payload; ///< the samples, as `encoding` says
    SampleEncoding encoding = SampleEncoding::exact;
    Bytes shapes{}; ///< those of all framelets; empty: the viewer has no use for them
    Bytes tracks{}; ///< empty: nothing moves but as the viewer knows
    bool operator==(EncodedBatch const&) const = default;
};

/// A heartbeat, which is sent every second and whenever the clock or the convergence changes.
struct Status {
    ClockState clock;
    std::uint64_t last_batch = 0; ///< the newest batch of this session
    std::uint64_t camera_number = 0; ///< the newest camera that arrived
    bool converged = false; ///< nothing more will come until something changes
    double samples_per_second = 0; ///< rendered for all sessions together
    std::uint32_t sessions = 0;
    bool controls = true; ///< as in Welcome, by now
    std::uint64_t evicted = 0; ///< how many messages Evicted of this viewer have come
    float busy = 0; ///< the share of the last second in which there was something to do for viewers, [0, 1]
    bool operator==(Status const&) const = default;
};

/// The other side did something that cannot be served; the connection ends after it. Either direction.
struct Failure {
    std::string text; ///< one line
    bool again = false; ///< the same may go well a little later
    bool operator==(Failure const&) const = default;
};

using Message = std::variant<Hello, CameraUpdate, ViewerSettings, ClockRequest, Ack, Evicted, Welcome, EncodedBatch,
                             Status, Failure, PathOrder, PathAnswer>;

/// Largest message body that either side accepts, bytes: what the largest batch needs, with room.
inline constexpr std::size_t max_message_bytes = 64u << 20;
/// The same limit before the handshake is over, and upstream at all times.
inline constexpr std::size_t max_upstream_message_bytes = 64u << 10;

} // namespace framelet
