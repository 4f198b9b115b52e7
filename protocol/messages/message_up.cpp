#include <algorithm>

#include "common/error.h"
#include "protocol/messages/message_wire.h"
#include "protocol/messages/text_limits.h"

namespace framelet {

Offset<wire::Hello> write(Builder& builder, Hello const& value) {
    wire::Ticket const ticket = write(value.ticket);
    Offset<wire::WorkOffer> work;
    if (value.work) {
        work = wire::CreateWorkOffer(builder, value.work->scene, value.work->light, value.work->threads);
    }
    return wire::CreateHello(builder, value.version, write_text(builder, value.token, max_token_bytes), value.codings,
                             value.ticket ? &ticket : nullptr, value.last_batch, work);
}

Hello read(wire::Hello const& wire) {
    Hello hello{wire.version(), read_text(wire.token(), max_token_bytes), wire.codings(), read(wire.ticket()),
                wire.last_batch()};
    if (wire::WorkOffer const* const work = wire.work()) {
        hello.work = {work->scene(), work->light(), work->threads()};
    }
    return hello;
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
    return wire::CreateViewerSettings(builder, value.exposure_ev, value.bias, value.reproject, value.paused);
}

ViewerSettings read(wire::ViewerSettings const& wire) {
    return {wire.exposure_ev(), wire.bias(), wire.reproject(), wire.paused()};
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

Offset<wire::Evicted> write(Builder& builder, Evicted const& value) {
    std::vector<std::uint64_t> batches;
    std::vector<std::uint16_t> counts;
    std::vector<std::uint32_t> tiles;
    for (SentTile const& sent : value.framelets) {
        if (batches.empty() || batches.back() != sent.batch) {
            batches.push_back(sent.batch);
            counts.push_back(0);
        }
        ++counts.back();
        tiles.push_back(sent.tile.code);
    }
    return wire::CreateEvictedDirect(builder, &batches, &counts, &tiles);
}

Evicted read(wire::Evicted const& wire) {
    Evicted value;
    std::size_t next = 0;
    for (flatbuffers::uoffset_t i = 0; i < std::min(wire.batches()->size(), wire.counts()->size()); ++i) {
        std::size_t const end = next + wire.counts()->Get(i);
        if (end > wire.tiles()->size()) {
            break;
        }
        for (; next < end; ++next) {
            Tile const tile{wire.tiles()->Get(static_cast<flatbuffers::uoffset_t>(next))};
            value.framelets.push_back({wire.batches()->Get(i), tile});
        }
    }
    if (wire.batches()->size() != wire.counts()->size() || next != wire.tiles()->size()) {
        throw ProtocolError("what the viewer evicts does not add up");
    }
    return value;
}

char const* problem(Evicted const& value) {
    if (value.framelets.size() > max_evicted) {
        return "the viewer evicts more than 4096 framelets at once";
    }
    auto const is_valid = [](SentTile const& sent) { return is_tile_code(sent.tile.code); };
    return std::ranges::all_of(value.framelets, is_valid) ? nullptr : "a tile code is invalid";
}

} // namespace framelet
