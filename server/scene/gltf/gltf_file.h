// Reads a .gltf or .glb file and takes it apart by tinygltf, with the checks that tinygltf leaves out. Images stay
// encoded. In: a path. Out: tinygltf's model, or an InputError that says what is wrong (without the file's name).
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "server/scene/reading/image_loading.h"
#include "server/scene/reading/import_budget.h"
#include "server/scene/reading/progress.h"
#include "server/scene/reading/scene_folder.h"

namespace tinygltf {
class Model;
}

namespace framelet {

class GltfAccessors;

/// Reads the file and the buffers and image files that it names. An image that is missing is left empty; anything
/// else that is missing is an InputError. External images are in `Image::image`, still encoded. An extension that the
/// importer does not know is a warning where the file uses it, and an InputError where the file requires it.
std::unique_ptr<tinygltf::Model> read_gltf(std::filesystem::path const& file, SceneFolder const& folder,
                                           ImportBudget& budget, std::vector<std::string>& warnings,
                                           Progress const& progress);

/// The model's images, still encoded; those that are missing have no bytes. The bytes live in `model`.
std::vector<EncodedImage> gltf_images(tinygltf::Model const& model, GltfAccessors const& accessors,
                                      SceneFolder const& folder);

} // namespace framelet
