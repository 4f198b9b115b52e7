// Codes the tiles of a batch as bytes: each by how far it lies behind the one before along the Morton curve, which is
// little, since batches are in its order. In: tiles in any order. Out: bytes, and back. PROTOCOL.md says how.
#pragma once

#include <span>
#include <vector>

#include "common/framelet/tile.h"
#include "protocol/messages/message.h"

namespace framelet {

/// Writes a list of tiles, which are of depths 0 to 15.
Bytes write_tiles(std::span<Tile const> tiles);
/// Reads a list of tiles. ProtocolError where the bytes are no such list, or one of more than a batch's framelets.
std::vector<Tile> read_tiles(ByteView bytes);

} // namespace framelet
