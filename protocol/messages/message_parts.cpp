#include "common/error.h"
#include "common/one_line.h"
#include "protocol/messages/message_wire.h"

namespace framelet {

wire::Vec3 write(Vec3 const& value) {
    return {value.x, value.y, value.z};
}

Vec3 read(wire::Vec3 const& wire) {
    return {wire.x(), wire.y(), wire.z()};
}

wire::Clock write(ClockState const& value) {
    return {value.time, value.speed, value.playing};
}

ClockState read(wire::Clock const& wire) {
    return {wire.time(), wire.playing(), wire.speed()};
}

wire::Ticket write(Ticket const& value) {
    return {value.high, value.low};
}

Ticket read(wire::Ticket const* wire) {
    return wire == nullptr ? Ticket{} : Ticket{wire->high(), wire->low()};
}

char const* problem(ClockState const& value) {
    if (!is_time(value.time)) {
        return "the clock's time is not within 0..1e9";
    }
    return in_range(value.speed, -max_clock_speed, max_clock_speed) ? nullptr
                                                                    : "the clock's speed is not within -16..16";
}

Offset<wire::Camera> write(Builder& builder, Camera const& value) {
    wire::Vec3 const position = write(value.position);
    Quat const& q = value.orientation;
    wire::Quat const orientation(q.x, q.y, q.z, q.w);
    return wire::CreateCamera(builder, &position, &orientation, static_cast<wire::Projection>(value.projection),
                              value.vertical_extent);
}

Camera read(wire::Camera const& wire) {
    if (wire.projection() > wire::Projection::MAX) {
        throw ProtocolError("a camera's projection is of an unknown kind");
    }
    wire::Quat const& q = *wire.orientation();
    Camera camera;
    camera.position = read(*wire.position());
    camera.orientation = Quat(q.w(), q.x(), q.y(), q.z());
    camera.projection = static_cast<Projection>(wire.projection());
    camera.vertical_extent = wire.vertical_extent();
    return camera;
}

char const* problem(Camera const& value) {
    return is_valid(value) ? nullptr : "a camera's position, orientation or vertical extent is out of its range";
}

Offset<wire::View> write(Builder& builder, NumberedView const& value) {
    wire::Viewport const viewport(static_cast<std::uint16_t>(value.viewport.width),
                                  static_cast<std::uint16_t>(value.viewport.height));
    return wire::CreateView(builder, value.number, write(builder, value.camera), &viewport, value.held_since);
}

NumberedView read(wire::View const& wire) {
    return {
        wire.number(), read(*wire.camera()), {wire.viewport()->width(), wire.viewport()->height()}, wire.held_since()};
}

char const* problem(NumberedView const& value) {
    if (!in_range(value.viewport.width, 1, max_viewport_side) ||
        !in_range(value.viewport.height, 1, max_viewport_side)) {
        return "a side of the viewport is not within 1..16384";
    }
    return problem(value.camera);
}

Offset<flatbuffers::String> write_text(Builder& builder, std::string const& text, std::size_t max_bytes) {
    return builder.CreateString(to_one_line(text, max_bytes));
}

std::string read_text(flatbuffers::String const* wire, std::size_t max_bytes) {
    if (wire == nullptr) {
        return {};
    }
    if (wire->size() > max_bytes) {
        throw ProtocolError("a text of " + std::to_string(wire->size()) + " bytes exceeds the limit of " +
                            std::to_string(max_bytes));
    }
    std::string text = wire->str();
    if (!is_one_line(text)) {
        throw ProtocolError("a text is not one line of UTF-8");
    }
    return text;
}

} // namespace framelet
