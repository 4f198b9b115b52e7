// Decodes the images of a scene in parallel.
// In: encoded images in memory or in files. Out: pictures; those that cannot be read are null and get a warning.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "server/scene/reading/import_budget.h"
#include "server/scene/reading/progress.h"
#include "server/scene/reading/scene_folder.h"
#include "server/scene/scene.h"

namespace framelet {

/// An image as the scene file gives it: its bytes, or else (no bytes) the file it is in.
struct EncodedImage {
    std::string name; ///< for messages
    std::span<std::byte const> bytes;
    std::filesystem::path file; ///< empty where there is no such file
    std::shared_ptr<Picture const> decoded = nullptr; ///< set where nothing is left to do
    std::string problem = {}; ///< why there is nothing to decode, where that is known
};

/// Decodes all images, of files those that `folder` opens. One that is missing or broken is null, with one line in
/// `warnings` that names it. Throws SceneTooLarge before one is decoded for which the budget has no room.
std::vector<std::shared_ptr<Picture const>> load_images(std::span<EncodedImage const> images, SceneFolder const& folder,
                                                        ImportBudget& budget, std::vector<std::string>& warnings,
                                                        Progress const& progress);

/// Removes images that are null, the textures that use them, and the uses of those by materials.
void drop_missing_images(Scene& scene);

} // namespace framelet
