// Writes binary glTF 2.0 files (.glb). In: a GltfDocument. Out: the bytes; the same document gives the same bytes.
#pragma once

#include <string>

#include "scenes/gltf/gltf_document.h"

namespace framelet {

/// Positions are rounded to 1/65536 m, colours and weights of joints to 1/255, everything else to 1/2^20, so that the
/// last bit of a sine does not reach the file. Aborts where the document names something that it does not hold.
std::string write_glb(GltfDocument const& document);

} // namespace framelet
