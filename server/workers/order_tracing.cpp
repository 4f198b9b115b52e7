#include "server/workers/order_tracing.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "common/error.h"
#include "common/laps.h"
#include "server/render/path/path_tracing.h"

namespace framelet {
namespace {

// These are nothing but floats, and travel as they are.
static_assert(std::is_trivially_copyable_v<TileLight> && sizeof(TileLight) == 3 * framelet_samples * sizeof(float));
static_assert(std::is_trivially_copyable_v<GatheredPacket> && sizeof(GatheredPacket) == 15 * sizeof(float));

template <class Value>
void append(Value const& value, std::vector<float>& out) {
    out.resize(out.size() + sizeof(Value) / sizeof(float));
    std::memcpy(out.data() + out.size() - sizeof(Value) / sizeof(float), &value, sizeof(Value));
}

/// False where there are not as many numbers as these have, or one is beyond `most`.
template <class Value>
bool read(std::vector<float> const& light, float most, std::span<Value> out) {
    if (light.size() * sizeof(float) != out.size_bytes() ||
        !std::ranges::all_of(light, [most](float value) { return std::abs(value) <= most; })) { // not for NaN
        return false;
    }
    std::memcpy(static_cast<void*>(out.data()), light.data(), out.size_bytes());
    return true;
}

bool is_radiance(Vec3 const& color) {
    return color.r >= 0 && color.g >= 0 && color.b >= 0;
}

bool is_gathered(GatheredPacket const& packet) {
    GatheredLight const& light = packet.light;
    return light.paths == lanes && is_radiance(light.sum.all) && is_radiance(light.sum.reflected) &&
           light.sum.open >= 0 && light.sum.open <= lanes && light.squares >= 0 && light.nearness >= 0 &&
           light.excess >= 0 && packet.first >= 0;
}

} // namespace

std::size_t count_paths(PathOrder const& order) {
    return order.tiles.size() * framelet_samples + order.places.size() * lanes;
}

PathAnswer trace_order(PathLight const& light, PathOrder const& order) {
    Laps laps;
    PathAnswer answer;
    answer.number = order.number;
    ViewRays const rays = make_view_rays(order.view.camera, order.view.viewport);
    ImagePlane const plane(order.view.viewport);
    TileLight tile;
    for (TilePath const& path : order.tiles) {
        trace_tile(light, rays, plane, path.tile, static_cast<int>(path.number), tile);
        append(tile, answer.light);
    }
    for (PlacePaths const& place : order.places) {
        if (place.frame > light.scene().scene.instances.size()) {
            throw ProtocolError("an order has a place on a body that this scene does not have");
        }
        append(
            gather_packet(light, {{place.frame, place.position, place.normal}, place.seed, place.first, place.bright}),
            answer.light);
    }
    answer.took_us = static_cast<std::uint32_t>(std::min(1e6 * laps.lap(), 1e9));
    return answer;
}

bool read_tiles(PathAnswer const& answer, std::span<TileLight> out) {
    constexpr float most = 1e15f; // its square is a number
    return read(answer.light, most, out) && std::ranges::all_of(out, [](TileLight const& tile) {
               auto const not_negative = [](float value) { return value >= 0; };
               return std::ranges::all_of(tile.red, not_negative) && std::ranges::all_of(tile.green, not_negative) &&
                      std::ranges::all_of(tile.blue, not_negative);
           });
}

bool read_places(PathAnswer const& answer, std::span<GatheredPacket> out) {
    constexpr float most = 1e30f;
    return read(answer.light, most, out) && std::ranges::all_of(out, is_gathered);
}

} // namespace framelet
