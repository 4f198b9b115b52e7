// Reads scene files. In: their paths. Out: a Scene value. glTF goes through tinygltf (exact to the specification:
// sparse accessors, step and spline keys, samplers, extensions), everything else through Assimp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "server/scene/reading/progress.h"
#include "server/scene/scene.h"

namespace framelet {

/// Limits on what a scene file may ask for, and what it must contain.
struct ImportOptions {
    /// Files that the scene names may lie outside its folder. A scene from elsewhere could read the server's disk
    /// and show what it finds.
    bool allow_outside = false;
    /// Upper bound of the bytes that geometry, animation and pictures take. A file of some KB can ask for any number. 4
    /// GiB is 64 pictures of 4096x4096 or a hundred million vertices, and leaves a machine of 16 GB the room for what
    /// rendering makes of it once more.
    std::uint64_t memory_bytes = std::uint64_t(4) << 30;
    /// Animation clips, by name, that the scene must have. A glTF file that is read alone is refused without them
    /// before its meshes and pictures are read; for all else `clips_named` does that.
    std::vector<std::string> clips;
    /// Program, framelet-server itself, that tries a file of Assimp's formats before this process reads it. Empty:
    /// there is none, and while Assimp reads, this process as a whole gets no more memory than what is left of
    /// `memory_bytes`.
    std::filesystem::path checker;
};

/// Reads and finishes a scene. Throws InputError with one line that names the file where it cannot be loaded. The scene
/// it returns is consistent: every index is in range, every attribute has the right length, every number is finite,
/// skin weights sum to 1.
Scene import_scene(std::filesystem::path const& file, Progress const& progress = {}, ImportOptions const& options = {});

/// Reads several scene files into one scene, each where it has its things (see `merged_scene`). All of them together
/// have the memory, each reads from its own folder. `progress` is told of each file by its name.
Scene import_scenes(std::span<std::filesystem::path const> files, Progress const& progress = {},
                    ImportOptions const& options = {});

} // namespace framelet
