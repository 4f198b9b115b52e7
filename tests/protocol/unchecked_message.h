// Messages whose numbers may be out of range, as a peer that does not check could send them. For tests only.
#pragma once

#include "protocol/messages/message_wire.h"

namespace framelet {

template <typename Table>
Bytes finish(Builder& builder, Offset<Table> body, wire::Body type = wire::BodyTraits<Table>::enum_value) {
    builder.Finish(wire::CreateMessage(builder, type, body.Union()), wire::MessageIdentifier());
    auto const* const data = reinterpret_cast<std::byte const*>(builder.GetBufferPointer());
    return {data, data + builder.GetSize()};
}

/// Body of one message.
template <typename Value>
Bytes unchecked(Value const& value) {
    Builder builder;
    return finish(builder, write(builder, value));
}

} // namespace framelet
