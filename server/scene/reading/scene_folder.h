// Decides which files a scene file may make us read: those in its own folder and below, wherever links lead.
// In: a file that the scene names, as a path. Out: whether it may be read, or the open file.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/files/regular_file.h"

namespace framelet {

class SceneFolder {
public:
    SceneFolder(std::filesystem::path const& scene_file, bool allow_outside);

    /// Folder that names in the scene file start from; absolute.
    std::filesystem::path const& path() const { return path_; }

    /// True where the file may be read, as its name leads now. False for what lies outside, there or not: a scene
    /// learns nothing of other folders.
    bool permits(std::filesystem::path const& file) const;

    /// Opens a file that may be read; nothing where there is none. It is what was opened that is judged: a name may
    /// have been permitted and be a link out of the folder by then. May be called from any thread.
    std::optional<RegularFile> open(std::filesystem::path const& file) const;

    /// The files that were asked for and permitted, in the order of names, whether they exist or not: what the scene
    /// depends on. Importers ask on one thread. Of more than `most_files` some are left out.
    std::vector<std::filesystem::path> asked_for() const { return {asked_for_.begin(), asked_for_.end()}; }
    static constexpr std::size_t most_files = 4096;

    /// Message that says why a file which is not permitted is not read: "file 'name' lies ...".
    static std::string refusal(char const* kind, std::string const& name) {
        return std::string(kind) + " '" + name + "' lies outside the scene's folder (--allow-outside permits that)";
    }

private:
    std::filesystem::path path_;
    std::filesystem::path canonical_;
    bool allow_outside_;
    mutable std::set<std::filesystem::path> asked_for_;

    bool note(std::filesystem::path const& file) const;
    bool has(std::filesystem::path const& canonical) const;
};

} // namespace framelet
