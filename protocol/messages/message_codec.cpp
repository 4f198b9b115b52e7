#include "protocol/messages/message_codec.h"

#include "common/error.h"
#include "protocol/messages/message_wire.h"

namespace framelet {
namespace {

/// The largest number of nested tables, for the deepest message (Message, Welcome, SceneCamera, Camera), and of tables,
/// for the largest; with room for tables that later versions add.
constexpr flatbuffers::uoffset_t max_table_depth = 8;
constexpr flatbuffers::uoffset_t max_tables = 4 * max_scene_cameras;

std::size_t size_hint(Message const& message) {
    auto const* const batch = std::get_if<EncodedBatch>(&message);
    return batch == nullptr ? 1024
                            : 1024 + batch->payload.size() + batch->shapes.size() + batch->tiles.size() * sizeof(Tile);
}

template <typename Table>
wire::Body type_of(Offset<Table>) {
    return wire::BodyTraits<Table>::enum_value;
}

template <typename Table>
Message value_of(Table const& table) {
    auto value = read(table);
    if (char const* const fault = problem(value)) {
        throw ProtocolError(fault);
    }
    return value;
}

Message value_of(wire::Message const& message) {
    switch (message.body_type()) {
    case wire::Body::Hello:
        return value_of(*message.body_as_Hello());
    case wire::Body::CameraUpdate:
        return value_of(*message.body_as_CameraUpdate());
    case wire::Body::ViewerSettings:
        return value_of(*message.body_as_ViewerSettings());
    case wire::Body::ClockRequest:
        return value_of(*message.body_as_ClockRequest());
    case wire::Body::Ack:
        return value_of(*message.body_as_Ack());
    case wire::Body::Evicted:
        return value_of(*message.body_as_Evicted());
    case wire::Body::Welcome:
        return value_of(*message.body_as_Welcome());
    case wire::Body::Batch:
        return value_of(*message.body_as_Batch());
    case wire::Body::Status:
        return value_of(*message.body_as_Status());
    case wire::Body::Failure:
        return value_of(*message.body_as_Failure());
    case wire::Body::PathOrder:
        return value_of(*message.body_as_PathOrder());
    case wire::Body::PathAnswer:
        return value_of(*message.body_as_PathAnswer());
    case wire::Body::NONE:
        break;
    }
    throw ProtocolError("a message is of the unknown type " + std::to_string(static_cast<int>(message.body_type())));
}

} // namespace

void append_message(Message const& message, Bytes& out) {
    if (char const* const fault = std::visit([](auto const& value) { return problem(value); }, message)) {
        throw UnsendableMessage(fault);
    }
    Builder builder(size_hint(message));
    std::visit(
        [&](auto const& value) {
            auto const body = write(builder, value);
            builder.Finish(wire::CreateMessage(builder, type_of(body), body.Union()), wire::MessageIdentifier());
        },
        message);
    auto const* const data = reinterpret_cast<std::byte const*>(builder.GetBufferPointer());
    out.insert(out.end(), data, data + builder.GetSize());
}

Bytes encode_message(Message const& message) {
    Bytes body;
    append_message(message, body);
    return body;
}

Message decode_message(ByteView body) {
    if (body.size() > max_message_bytes) {
        throw ProtocolError("a message is larger than 64 MiB");
    }
    Bytes aligned; // numbers are read in place: the body must start at a multiple of eight
    if (reinterpret_cast<std::uintptr_t>(body.data()) % 8 != 0) {
        aligned.assign(body.begin(), body.end());
        body = aligned;
    }
    auto const* const data = reinterpret_cast<std::uint8_t const*>(body.data());
    flatbuffers::Verifier verifier(data, body.size(), max_table_depth, max_tables);
    if (!wire::VerifyMessageBuffer(verifier)) {
        throw ProtocolError("a message is not well-formed");
    }
    return value_of(*wire::GetMessage(data));
}

} // namespace framelet
