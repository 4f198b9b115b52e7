// Paths of light as a server orders them from its workers. In: a posed scene, an order. Out: what its paths bring, the
// same bits wherever it is traced.
#pragma once

#include <span>

#include "protocol/messages/message.h"
#include "server/render/gathering/light_gathering.h"
#include "server/render/path/path_light.h"

namespace framelet {

/// How many paths an order is of.
std::size_t count_paths(PathOrder const& order);

/// Traces an order's paths on the calling thread; the scene has to be posed for its time, and displayed as it says.
/// Throws ProtocolError where it has no such place.
PathAnswer trace_order(PathLight const& light, PathOrder const& order);

/// Reads what an answer says of all the tiles of its order; false where that is no light of so many.
bool read_tiles(PathAnswer const& answer, std::span<TileLight> out);
/// Likewise of the places of an order that has these.
bool read_places(PathAnswer const& answer, std::span<GatheredPacket> out);

} // namespace framelet
