// What whoever has a scene read may ask for.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

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
    /// The scene of a glTF file that is shown, by name or number (from 0). Empty: the one that the file says.
    std::string scene;
    /// What a file's coordinates mean where it does not say so (`parse_up_axis`, `parse_unit`).
    std::string up = "y", unit = "m";
    /// Program, framelet-server itself, that tries a file before this process reads it: a reader that crashes takes its
    /// process along. Empty: there is none.
    std::filesystem::path checker;
    /// True where this process has viewers: every file is tried before, and one that ends too early is refused. Else
    /// only those are of formats with trees, which Assimp goes through recursively; and while it reads, this process as
    /// a whole gets no more memory than what is left of `memory_bytes`.
    bool is_serving = false;
    /// How long the checker may go on without a sign of progress.
    std::chrono::milliseconds checker_patience = std::chrono::minutes(5);
};

} // namespace framelet
