// Checks what the header of a mesh file promises against the file's size: Assimp takes memory for as many elements as
// the header says before it reads the first.
#pragma once

#include <filesystem>

namespace framelet {

/// Throws InputError where a .off file cannot hold the vertices and faces that its header promises. Other formats have
/// no such counts, or Assimp checks them.
void check_mesh_header(std::filesystem::path const& file);

} // namespace framelet
