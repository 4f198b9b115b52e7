#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "protocol/messages/message_wire.h"

namespace framelet {
namespace {

/// Numbers of an answer that is a message of the usual size.
constexpr std::size_t max_light = (max_upstream_message_bytes - 1024) / sizeof(float);

bool is_within(Vec3 const& value, float most) {
    return std::abs(value.x) <= most && std::abs(value.y) <= most && std::abs(value.z) <= most; // false for NaN
}

bool is_place(PlacePaths const& value) {
    constexpr float unit = 1.001f;
    return is_within(value.position, max_camera_coordinate) && is_within(value.normal, unit) && value.bright >= 0;
}

} // namespace

Offset<wire::PathOrder> write(Builder& builder, PathOrder const& value) {
    auto const view = write(builder, value.view);
    auto const tiles =
        builder.CreateVectorOfStructs<wire::TilePath>(value.tiles.size(), [&](std::size_t i, wire::TilePath* out) {
            *out = {value.tiles[i].tile.code, value.tiles[i].number};
        });
    auto const places =
        builder.CreateVectorOfStructs<wire::PlacePaths>(value.places.size(), [&](std::size_t i, wire::PlacePaths* out) {
            PlacePaths const& place = value.places[i];
            *out = {place.frame, write(place.position), write(place.normal), place.seed, place.first, place.bright};
        });
    return wire::CreatePathOrder(builder, value.number, value.round, value.scene_time, view, value.display.exposure,
                                 static_cast<std::uint8_t>(value.display.curve), tiles, places);
}

PathOrder read(wire::PathOrder const& wire) {
    PathOrder value;
    value.number = wire.number();
    value.round = wire.round();
    value.scene_time = wire.scene_time();
    value.view = read(*wire.view());
    if (wire.tone_curve() > static_cast<std::uint8_t>(ToneCurve::linear)) {
        throw ProtocolError("a tone curve is of an unknown kind");
    }
    value.display = {wire.exposure(), static_cast<ToneCurve>(wire.tone_curve())};
    for (flatbuffers::uoffset_t i = 0; wire.tiles() != nullptr && i < wire.tiles()->size(); ++i) {
        wire::TilePath const& tile = *wire.tiles()->Get(i);
        value.tiles.push_back({{tile.tile()}, tile.number()});
    }
    for (flatbuffers::uoffset_t i = 0; wire.places() != nullptr && i < wire.places()->size(); ++i) {
        wire::PlacePaths const& place = *wire.places()->Get(i);
        value.places.push_back(
            {place.frame(), read(place.position()), read(place.normal()), place.seed(), place.first(), place.bright()});
    }
    return value;
}

char const* problem(PathOrder const& value) {
    if (!is_time(value.scene_time)) {
        return "an order's time is not within 0..1e9";
    }
    if (!(value.display.exposure > 0 && std::isfinite(value.display.exposure))) {
        return "an order's exposure is not above 0";
    }
    if (value.tiles.size() > max_order_tiles || value.places.size() > max_order_places ||
        (!value.tiles.empty() && !value.places.empty())) {
        return "an order is of more tiles or places than an answer has room for, or of both";
    }
    Viewport const viewport = value.view.viewport;
    if (char const* const fault = problem(value.view)) {
        return fault;
    }
    ImagePlane const plane(viewport);
    if (!std::ranges::all_of(value.tiles, [&](TilePath const& path) { return plane.accepts(path.tile); })) {
        return "an order's tile is not of its view";
    }
    return std::ranges::all_of(value.places, is_place) ? nullptr : "an order's place is out of its range";
}

Offset<wire::PathAnswer> write(Builder& builder, PathAnswer const& value) {
    return wire::CreatePathAnswer(builder, value.number, value.took_us, builder.CreateVector(value.light));
}

PathAnswer read(wire::PathAnswer const& wire) {
    return {wire.number(), wire.took_us(), {wire.light()->begin(), wire.light()->end()}};
}

char const* problem(PathAnswer const& value) {
    if (value.light.size() > max_light) {
        return "an answer is larger than any order asks for";
    }
    return std::ranges::all_of(value.light, [](float light) { return std::isfinite(light); })
               ? nullptr
               : "an answer has numbers that are none";
}

} // namespace framelet
