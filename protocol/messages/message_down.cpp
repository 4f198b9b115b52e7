#include <algorithm>

#include "common/error.h"
#include "protocol/messages/message_wire.h"
#include "protocol/messages/text.h"

namespace framelet {
namespace {

/// A Welcome has to fit into the limit before the handshake is over: the cameras' names and lenses take no more than
/// this (and one longest), which leaves room for their list, the other names and the rest.
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

Offset<wire::Section> write_section(Builder& builder, wire::Content content, wire::Encoding encoding, ByteView bytes) {
    auto const data = builder.CreateVector(reinterpret_cast<std::uint8_t const*>(bytes.data()), bytes.size());
    return wire::CreateSection(builder, content, encoding, data);
}

Bytes read_bytes(wire::Section const& section) {
    auto const* const data = reinterpret_cast<std::byte const*>(section.data()->data());
    return {data, data + section.data()->size()};
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
    return wire::CreateWelcome(builder, value.version, server, scene, value.scene_bounds.empty() ? nullptr : &box,
                               start, builder.CreateVector(cameras), value.animation_duration, &clock,
                               value.scene_identity, value.controls, value.ticket ? &ticket : nullptr, value.resumed,
                               value.let_go);
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
    value.let_go = wire.let_go();
    return value;
}

char const* problem(Welcome const& value) {
    if (!value.scene_bounds.empty() && !is_finite_box(value.scene_bounds)) {
        return "the scene's bounds are not a box";
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
    std::vector<Offset<wire::Section>> list{
        write_section(builder, wire::Content::colour, static_cast<wire::Encoding>(value.encoding), value.payload)};
    if (!value.shapes.empty()) {
        list.push_back(write_section(builder, wire::Content::shape, wire::Encoding::layers_ranges, value.shapes));
    }
    if (!value.tracks.empty()) {
        list.push_back(write_section(builder, wire::Content::track, wire::Encoding::tracks_zstd, value.tracks));
    }
    auto const sections = builder.CreateVector(list);
    std::uint32_t* codes = nullptr;
    auto const tiles = builder.CreateUninitializedVector(value.tiles.size(), &codes);
    std::transform(value.tiles.begin(), value.tiles.end(), codes, [](Tile tile) { return tile.code; });
    auto const view = write(builder, value.view);
    return wire::CreateBatch(builder, value.number, view, value.scene_time, tiles, sections, value.shown_from,
                             value.outdates);
}

namespace {

void take(wire::Section const& section, EncodedBatch& batch) {
    wire::Encoding const encoding = section.encoding();
    switch (section.content()) {
    case wire::Content::colour:
        if (encoding != wire::Encoding::planes_left_zstd && encoding != wire::Encoding::haar_ranges &&
            encoding != wire::Encoding::predicted_haar_ranges) {
            throw ProtocolError("a batch's samples are in an unknown encoding");
        }
        batch.encoding = static_cast<SampleEncoding>(encoding);
        batch.payload = read_bytes(section);
        return;
    case wire::Content::shape:
        if (encoding != wire::Encoding::layers_ranges) {
            throw ProtocolError("a batch's shapes are in an unknown encoding");
        }
        batch.shapes = read_bytes(section);
        return;
    case wire::Content::track:
        if (encoding != wire::Encoding::tracks_zstd) {
            throw ProtocolError("a batch's tracks are in an unknown encoding");
        }
        batch.tracks = read_bytes(section);
        return;
    case wire::Content::none:
        break;
    }
    throw ProtocolError("a batch's section holds something unknown");
}

} // namespace

EncodedBatch read(wire::Batch const& wire) {
    if (wire.sections()->size() == 0) {
        throw ProtocolError("a batch has no section");
    }
    EncodedBatch value;
    wire::Content before = wire::Content::none;
    for (wire::Section const* const section : *wire.sections()) {
        if (section->content() <= before ||
            (before == wire::Content::none && section->content() != wire::Content::colour)) {
            throw ProtocolError("a batch's sections are out of order");
        }
        before = section->content();
        take(*section, value);
    }
    if (wire.tiles()->size() > max_batch_framelets) {
        throw ProtocolError("a batch has more than 32768 framelets");
    }
    value.number = wire.number();
    value.view = read(*wire.view());
    value.scene_time = wire.scene_time();
    value.shown_from = wire.shown_from();
    value.outdates = wire.outdates();
    value.tiles.reserve(wire.tiles()->size());
    for (std::uint32_t const code : *wire.tiles()) {
        value.tiles.push_back({code});
    }
    return value;
}

char const* problem(EncodedBatch const& value) {
    if (value.number == 0) {
        return "a batch has the number 0";
    }
    if (char const* const fault = problem(value.view)) {
        return fault;
    }
    if (!is_time(value.scene_time)) {
        return "a batch's scene time is not within 0..1e9";
    }
    if (!is_time(value.shown_from)) {
        return "the time from which a batch is shown is not within 0..1e9";
    }
    if (value.tiles.size() > max_batch_framelets) {
        return "a batch has more than 32768 framelets";
    }
    ImagePlane const plane(value.view.viewport);
    if (!std::all_of(value.tiles.begin(), value.tiles.end(), [&](Tile tile) { return plane.accepts(tile); })) {
        return "a batch has a tile that its viewport does not have";
    }
    if (has_duplicate(value.tiles)) {
        return "a batch has the same tile twice";
    }
    return nullptr;
}

Offset<wire::Status> write(Builder& builder, Status const& value) {
    wire::Clock const clock = write(value.clock);
    return wire::CreateStatus(builder, &clock, value.last_batch, value.camera_number, value.converged,
                              value.samples_per_second, value.sessions, value.controls, value.let_go);
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
    value.let_go = wire.let_go();
    return value;
}

char const* problem(Status const& value) {
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
