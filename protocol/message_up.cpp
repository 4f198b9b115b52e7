#include "protocol/message_wire.h"
#include "protocol/text.h"

namespace framelet {

Offset<wire::Hello> write(Builder& builder, Hello const& value) {
    return wire::CreateHello(builder, value.version, write_text(builder, value.token, max_token_bytes), value.codings);
}

Hello read(wire::Hello const& wire) {
    return {wire.version(), read_text(wire.token(), max_token_bytes), wire.codings()};
}

char const* problem(Hello const&) {
    return nullptr; // any version is read, so that it can be answered
}

Offset<wire::CameraUpdate> write(Builder& builder, CameraUpdate const& value) {
    return wire::CreateCameraUpdate(builder, write(builder, value.view), value.scene_camera);
}

CameraUpdate read(wire::CameraUpdate const& wire) {
    return {read(*wire.view()), wire.scene_camera()};
}

char const* problem(CameraUpdate const& value) {
    if (!in_range(value.scene_camera, -1, static_cast<double>(max_scene_cameras - 1))) {
        return "the camera of the scene is not within -1..4095";
    }
    return problem(value.view);
}

Offset<wire::ViewerSettings> write(Builder& builder, ViewerSettings const& value) {
    return wire::CreateViewerSettings(builder, value.exposure_ev, value.bias, value.reproject);
}

ViewerSettings read(wire::ViewerSettings const& wire) {
    return {wire.exposure_ev(), wire.bias(), wire.reproject()};
}

char const* problem(ViewerSettings const& value) {
    if (!in_range(value.exposure_ev, -16, 16)) {
        return "the exposure is not within -16..16";
    }
    return in_range(value.bias, -1, 1) ? nullptr : "the bias is not within -1..1";
}

Offset<wire::ClockRequest> write(Builder& builder, ClockRequest const& value) {
    wire::Clock const clock = write(value.state);
    return wire::CreateClockRequest(builder, value.set, &clock);
}

ClockRequest read(wire::ClockRequest const& wire) {
    return {wire.set(), read(*wire.clock())};
}

char const* problem(ClockRequest const& value) {
    constexpr unsigned known = ClockRequest::time | ClockRequest::playing | ClockRequest::speed;
    return (value.set & ~known) != 0 ? "the clock request sets an unknown field" : problem(value.state);
}

Offset<wire::Ack> write(Builder& builder, Ack const& value) {
    return wire::CreateAck(builder, value.batch, value.received_us, value.decode_us);
}

Ack read(wire::Ack const& wire) {
    return {wire.batch(), wire.received_us(), wire.decode_us()};
}

char const* problem(Ack const&) {
    return nullptr;
}

} // namespace framelet
