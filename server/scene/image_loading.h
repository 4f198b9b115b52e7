// The images of a scene, decoded in parallel.
// In: encoded images in memory or in files. Out: pictures; those that cannot be read are null and get a warning.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "server/scene/scene_import.h"

namespace framelet {

/// An image as the scene file gives it: its bytes, or else (no bytes) the file it is in.
struct EncodedImage {
    std::string name; ///< for messages
    std::span<std::byte const> bytes;
    std::filesystem::path file; ///< empty where there is no such file
    std::shared_ptr<Picture const> decoded = nullptr; ///< set where nothing is left to do
};

/// Decodes all images. One that is missing or broken is null, with one line in `warnings` that names it. Decoding
/// stops with an InputError where all together would need more than `max_image_bytes`.
std::vector<std::shared_ptr<Picture const>> load_images(std::span<EncodedImage const> images,
                                                        std::vector<std::string>& warnings, Progress const& progress);

inline constexpr std::uint64_t max_image_bytes = std::uint64_t(4) << 30;

/// Removes images that are null, the textures that use them, and the uses of those by materials.
void drop_missing_images(Scene& scene);

} // namespace framelet
