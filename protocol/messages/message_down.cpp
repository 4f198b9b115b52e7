#include <algorithm>
#include <cmath>
#include <span>

#include "common/error.h"
#include "protocol/messages/message_wire.h"
#include "protocol/messages/text_limits.h"
#include "protocol/messages/tile_list.h"

namespace framelet {
namespace {

/// Bytes of a Welcome that its cameras' names and lenses take at most (and one longest): a Welcome has to fit into the
/// limit before the handshake is over, and this leaves room for their list, the other names and the rest.
constexpr std::size_t max_cameras_bytes = max_upstream_message_bytes - 8192;

bool is_finite_box(Bounds const& box) {
    bool fine = true;
    for (int axis = 0; axis < 3; ++axis) {
        fine = fine && std::isfinite(box.lower[axis]) && std::isfinite(box.upper[axis]) &&
               box.lower[axis] <= box.upper[axis];
    }
    return fine;
}

bool has_duplicate(std::vector<Tile> tiles) {
    std::sort(tiles.begin(), tiles.end());
    return std::adjacent_find(tiles.begin(), tiles.end()) != tiles.end();
}

Offset<flatbuffers::Vector<std::uint8_t>> write_bytes(Builder& builder, ByteView bytes) {
    return builder.CreateVector(reinterpret_cast<std::uint8_t const*>(bytes.data()), bytes.size());
}

/// Writes bytes as a field, which is left out where there are none.
Offset<flatbuffers::Vector<std::uint8_t>> write_some(Builder& builder, ByteView bytes) {
    return bytes.empty() ? Offset<flatbuffers::Vector<std::uint8_t>>() : write_bytes(builder, bytes);
}

ByteView read_bytes(flatbuffers::Vector<std::uint8_t> const* bytes) {
    return bytes == nullptr ? ByteView() : std::as_bytes(std::span(bytes->data(), bytes->size()));
}

Bytes copy(ByteView bytes) {
    return {bytes.begin(), bytes.end()};
}

SampleEncoding read(wire::Encoding encoding) {
    if (encoding != wire::Encoding::planes_left_zstd && encoding != wire::Encoding::haar_ranges &&
        encoding != wire::Encoding::predicted_haar_ranges) {
        throw ProtocolError("a batch's samples are in an unknown encoding");
    }
    return static_cast<SampleEncoding>(encoding);
}

} // namespace

Offset<wire::Welcome> write(Builder& builder, Welcome const& value) {
    std::vector<Offset<wire::SceneCamera>> cameras;
    for (SceneCameraInfo const& info : value.cameras) {
        if (builder.GetSize() > max_cameras_bytes) {
            break;
        }
        auto const name = write_text(builder, info.name, max_name_bytes);
        cameras.push_back(wire::CreateSceneCamera(builder, name, write(builder, info.camera)));
    }
    wire::Clock const clock = write(value.clock);
    wire::Box const box(write(value.scene_bounds.lower), write(value.scene_bounds.upper));
    auto const server = write_text(builder, value.server, max_name_bytes);
    auto const scene = write_text(builder, value.scene_name, max_name_bytes);
    auto const start = write(builder, value.start_camera);
    wire::Ticket const ticket = write(value.ticket);
    wire::Vec3d const origin(value.scene_origin.x, value.scene_origin.y, value.scene_origin.z);
    return wire::CreateWelcome(builder, value.version, server, scene, value.scene_bounds.empty() ? nullptr : &box,
                               start, builder.CreateVector(cameras), value.animation_duration, &clock,
                               value.scene_identity, value.controls, value.ticket ? &ticket : nullptr, value.resumed,
                               value.evicted, value.scene_source,
                               value.scene_origin == glm::dvec3(0) ? nullptr : &origin);
}

Welcome read(wire::Welcome const& wire) {
    Welcome value;
    value.version = wire.version();
    value.server = read_text(wire.server(), max_name_bytes);
    value.scene_name = read_text(wire.scene_name(), max_name_bytes);
    if (wire.scene_bounds() != nullptr) {
        value.scene_bounds = {read(wire.scene_bounds()->lower()), read(wire.scene_bounds()->upper())};
        if (!is_finite_box(value.scene_bounds)) {
            throw ProtocolError("the scene's bounds are not a box");
        }
    }
    value.start_camera = read(*wire.start_camera());
    if (wire.cameras() != nullptr) {
        if (wire.cameras()->size() > max_scene_cameras) {
            throw ProtocolError("the scene has more than 4096 cameras");
        }
        for (wire::SceneCamera const* info : *wire.cameras()) {
            value.cameras.push_back({read_text(info->name(), max_name_bytes), read(*info->camera())});
        }
    }
    value.animation_duration = wire.animation_duration();
    value.clock = read(*wire.clock());
    value.scene_identity = wire.scene_identity();
    value.controls = wire.controls();
    value.ticket = read(wire.ticket());
    value.resumed = wire.resumed();
    value.evicted = wire.evicted();
    value.scene_source = wire.scene_source();
    if (wire::Vec3d const* const origin = wire.scene_origin()) {
        value.scene_origin = {origin->x(), origin->y(), origin->z()};
    }
    return value;
}

char const* problem(Welcome const& value) {
    if (!value.scene_bounds.empty() && !is_finite_box(value.scene_bounds)) {
        return "the scene's bounds are not a box";
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (!in_range(value.scene_origin[axis], -max_camera_coordinate, max_camera_coordinate)) {
            return "the scene's origin is not within 1e10 m";
        }
    }
    if (!is_time(value.animation_duration)) {
        return "the animation's duration is not within 0..1e9";
    }
    for (SceneCameraInfo const& info : value.cameras) {
        if (char const* const fault = problem(info.camera)) {
            return fault;
        }
    }
    char const* const fault = problem(value.start_camera);
    return fault != nullptr ? fault : problem(value.clock);
}

Offset<wire::Batch> write(Builder& builder, EncodedBatch const& value) {
    auto const tracks = write_some(builder, value.tracks);
    auto const shapes = write_some(builder, value.shapes);
    auto const colours = write_bytes(builder, value.payload);
    auto const tiles = write_bytes(builder, write_tiles(value.tiles));
    Offset<wire::Moment> moment;
    if (value.moment) {
        auto const view = write(builder, value.moment->view);
        moment = wire::CreateMoment(builder, view, value.moment->scene_time, value.moment->shown_from,
                                    value.moment->outdates);
    }
    return wire::CreateBatch(builder, value.number, moment, static_cast<wire::Encoding>(value.encoding), tiles, colours,
                             shapes, tracks);
}

EncodedBatch read(wire::Batch const& wire) {
    EncodedBatch value;
    value.number = wire.number();
    value.moment.reset();
    if (wire::Moment const* const moment = wire.moment()) {
        value.moment = {read(*moment->view()), moment->scene_time(), moment->shown_from(), moment->outdates()};
    }
    value.encoding = read(wire.encoding());
    value.tiles = read_tiles(read_bytes(wire.tiles()));
    value.payload = copy(read_bytes(wire.colours()));
    value.shapes = copy(read_bytes(wire.shapes()));
    value.tracks = copy(read_bytes(wire.tracks()));
    return value;
}

namespace {

char const* problem(BatchMoment const& moment) {
    if (char const* const fault = problem(moment.view)) {
        return fault;
    }
    if (!is_time(moment.scene_time)) {
        return "a batch's scene time is not within 0..1e9";
    }
    return is_time(moment.shown_from) ? nullptr : "the time from which a batch is shown is not within 0..1e9";
}

} // namespace

/// Does not ask whether the viewport has these tiles: that is seen when the batch is decoded.
char const* problem(EncodedBatch const& value) {
    if (value.number == 0) {
        return "a batch has the number 0";
    }
    if (char const* const fault = value.moment ? problem(*value.moment) : nullptr) {
        return fault;
    }
    if (value.tiles.size() > max_batch_framelets) {
        return "a batch has more than 32768 framelets";
    }
    if (!std::all_of(value.tiles.begin(), value.tiles.end(), [](Tile tile) { return is_tile_code(tile.code); })) {
        return "a batch has a tile that no plane has";
    }
    if (has_duplicate(value.tiles)) {
        return "a batch has the same tile twice";
    }
    return nullptr;
}

Offset<wire::Status> write(Builder& builder, Status const& value) {
    wire::Clock const clock = write(value.clock);
    return wire::CreateStatus(builder, &clock, value.last_batch, value.camera_number, value.converged,
                              value.samples_per_second, value.sessions, value.controls, value.evicted, value.busy);
}

Status read(wire::Status const& wire) {
    Status value;
    value.clock = read(*wire.clock());
    value.last_batch = wire.last_batch();
    value.camera_number = wire.camera_number();
    value.converged = wire.converged();
    value.samples_per_second = wire.samples_per_second();
    value.sessions = wire.sessions();
    value.controls = wire.controls();
    value.evicted = wire.evicted();
    value.busy = wire.busy();
    return value;
}

char const* problem(Status const& value) {
    if (!(value.busy >= 0 && value.busy <= 1)) {
        return "the share of the time that the server is busy is not within 0..1";
    }
    if (!std::isfinite(value.samples_per_second) || value.samples_per_second < 0) {
        return "the samples per second are not a finite number >= 0";
    }
    return problem(value.clock);
}

Offset<wire::Failure> write(Builder& builder, Failure const& value) {
    return wire::CreateFailure(builder, write_text(builder, value.text, max_failure_bytes), value.again);
}

Failure read(wire::Failure const& wire) {
    return {read_text(wire.text(), max_failure_bytes), wire.again()};
}

char const* problem(Failure const&) {
    return nullptr;
}

} // namespace framelet
