// Turns values into FlatBuffers tables and back, for the sources of this folder: `write` puts a value into a builder,
// `read` takes one out of a verified table (ProtocolError for what a value cannot hold: long text, unknown enum
// values), `problem` names the first field whose number is out of its range, nullptr where all are fine.
#pragma once

#include <string>

#include <framelet_generated.h>

#include "protocol/messages/message.h"

namespace framelet {

using Builder = flatbuffers::FlatBufferBuilder;
template <typename Table>
using Offset = flatbuffers::Offset<Table>;

/// The largest number of cameras of a scene that a Welcome lists.
inline constexpr std::size_t max_scene_cameras = 4096;

inline bool in_range(double value, double lowest, double highest) {
    return value >= lowest && value <= highest; // false for NaN
}
inline bool is_time(double seconds) {
    return in_range(seconds, 0, max_scene_time);
}

// --- parts of messages
wire::Vec3 write(Vec3 const& value);
Vec3 read(wire::Vec3 const& wire);
wire::Clock write(ClockState const& value);
ClockState read(wire::Clock const& wire);
char const* problem(ClockState const& value);
wire::Ticket write(Ticket const& value);
Ticket read(wire::Ticket const* wire);
Offset<wire::Camera> write(Builder& builder, Camera const& value);
Camera read(wire::Camera const& wire);
char const* problem(Camera const& value);
Offset<wire::View> write(Builder& builder, NumberedView const& value);
NumberedView read(wire::View const& wire);
char const* problem(NumberedView const& value);
/// Writes text, made one line and cut, because it comes from files; on reading such text is refused.
Offset<flatbuffers::String> write_text(Builder& builder, std::string const& text, std::size_t max_bytes);
std::string read_text(flatbuffers::String const* wire, std::size_t max_bytes);

// --- upstream
Offset<wire::Hello> write(Builder& builder, Hello const& value);
Hello read(wire::Hello const& wire);
char const* problem(Hello const& value);
Offset<wire::CameraUpdate> write(Builder& builder, CameraUpdate const& value);
CameraUpdate read(wire::CameraUpdate const& wire);
char const* problem(CameraUpdate const& value);
Offset<wire::ViewerSettings> write(Builder& builder, ViewerSettings const& value);
ViewerSettings read(wire::ViewerSettings const& wire);
char const* problem(ViewerSettings const& value);
Offset<wire::ClockRequest> write(Builder& builder, ClockRequest const& value);
ClockRequest read(wire::ClockRequest const& wire);
char const* problem(ClockRequest const& value);
Offset<wire::Ack> write(Builder& builder, Ack const& value);
Ack read(wire::Ack const& wire);
char const* problem(Ack const& value);
Offset<wire::Evicted> write(Builder& builder, Evicted const& value);
Evicted read(wire::Evicted const& wire);
char const* problem(Evicted const& value);

// --- of workers
Offset<wire::PathOrder> write(Builder& builder, PathOrder const& value);
PathOrder read(wire::PathOrder const& wire);
char const* problem(PathOrder const& value);
Offset<wire::PathAnswer> write(Builder& builder, PathAnswer const& value);
PathAnswer read(wire::PathAnswer const& wire);
char const* problem(PathAnswer const& value);

// --- downstream, and either direction
Offset<wire::Welcome> write(Builder& builder, Welcome const& value);
Welcome read(wire::Welcome const& wire);
char const* problem(Welcome const& value);
Offset<wire::Batch> write(Builder& builder, EncodedBatch const& value);
EncodedBatch read(wire::Batch const& wire);
char const* problem(EncodedBatch const& value);
Offset<wire::Status> write(Builder& builder, Status const& value);
Status read(wire::Status const& wire);
char const* problem(Status const& value);
Offset<wire::Failure> write(Builder& builder, Failure const& value);
Failure read(wire::Failure const& wire);
char const* problem(Failure const& value);

} // namespace framelet
