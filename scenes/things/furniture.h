// Furniture of rooms, and what it is made of. Metres; all stands on y = 0 and faces +Z.
#pragma once

#include "scenes/gltf/gltf_document.h"

namespace framelet {

/// Indices of the materials of a furnished room.
struct RoomMaterials {
    int boards, bricks, plaster, rug, map, wood, cloth, china, paint, brass, glow;
};

RoomMaterials add_room_materials(GltfDocument& document);

/// A table of 1.5 x 0.9, laid.
void add_table(GltfDocument& document, RoomMaterials const& materials, D3 place);
/// Returns the mesh of a chair.
int add_chair_mesh(GltfDocument& document, RoomMaterials const& materials);
/// A shelf with books, 1.3 wide, 1.75 high.
void add_book_shelf(GltfDocument& document, RoomMaterials const& materials, D3 place);
/// A sofa, 1.9 wide.
void add_sofa(GltfDocument& document, RoomMaterials const& materials, Placement const& place);
/// A picture frame of 1.5 x 0.75 on a wall; `place` is the middle of its lower edge.
void add_framed_map(GltfDocument& document, RoomMaterials const& materials, D3 place);
/// A hanging lamp whose light is below its bulb, since a bulb's own surface would shade it.
void add_lamp(GltfDocument& document, RoomMaterials const& materials, D3 place, D3 color, double candela);

} // namespace framelet
