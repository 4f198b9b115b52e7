// Reads a .gltf or .glb file: its JSON and the buffers that this names. Images stay encoded.
// In: a path. Out: the file as it is, unchecked; an InputError (without the file's name) where it is no glTF.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "server/scene/gltf/gltf_json.h"
#include "server/scene/reading/image_loading.h"
#include "server/scene/reading/import_budget.h"
#include "server/scene/reading/progress.h"
#include "server/scene/reading/scene_folder.h"

namespace framelet {

class GltfAccessors;

struct GltfFile {
    GltfFile() noexcept(false) = default; // memory for the JSON may be missing
    GltfFile(GltfFile const&) = delete; // its spans lead into its own memory
    GltfFile& operator=(GltfFile const&) = delete;

    Json json; ///< without `extras`, but for those of `asset`
    std::vector<std::span<std::byte const>> buffers; ///< as long as they say; empty where they cannot be read
    std::map<Index, std::span<std::byte const>> decoded_views; ///< buffer views that were compressed
    std::vector<std::vector<std::byte>> memory; ///< what these lie in
    bool is_truncated = false; ///< as of `Scene`
    std::string lacks; ///< what the file requires and the importer does not read, as a line; empty: nothing
};

/// Reads the file and the buffers that it names. What of them is missing goes to `faults`; to `remarks` what of the
/// file is not read, since it is of an extension that the importer does not know.
std::unique_ptr<GltfFile> read_gltf(std::filesystem::path const& file, SceneFolder const& folder, ImportBudget& budget,
                                    std::vector<std::string>& remarks, std::vector<std::string>& faults,
                                    Progress const& progress);

/// The file's images, still encoded; those that are missing say why, those found by another name in `remarks`. What
/// they lie in is kept in `file`.
std::vector<EncodedImage> gltf_images(GltfFile& file, GltfAccessors const& accessors, SceneFolder const& folder,
                                      ImportBudget& budget, std::vector<std::string>& remarks);

} // namespace framelet
