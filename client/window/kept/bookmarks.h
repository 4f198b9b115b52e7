// The user's own views in a scene, kept in a file. In: cameras. Out: that file, as `bookmarks_text`, and back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "client/viewer/bookmark_list.h"
#include "common/camera.h"

namespace framelet {

/// Files of a scene's bookmarks; empty: there is none.
struct BookmarkFiles {
    std::filesystem::path own;
    std::filesystem::path older; ///< read to begin with: what earlier versions kept, for whatever scene had the name
};

/// The files in which a scene's bookmarks are kept, named as `file_stem_of_scene`.
BookmarkFiles bookmark_files(std::string const& scene_name, std::uint64_t scene_source);

/// The bookmarks of one scene, kept in a file.
class Bookmarks {
public:
    /// Reads the file or, where there is none, the older one, which is never written. Where that cannot be used there
    /// are none, and `complaint` is one line. Files hold positions as the scene's file has them, `all` has them from
    /// its `origin`.
    explicit Bookmarks(std::filesystem::path file, std::filesystem::path const& older = {},
                       glm::dvec3 const& origin = glm::dvec3(0));
    explicit Bookmarks(BookmarkFiles const& files, glm::dvec3 const& origin = glm::dvec3(0))
        : Bookmarks(files.own, files.older, origin) {}

    std::vector<Bookmark> const& all() const { return all_; }
    std::string const& complaint() const { return complaint_; }

    /// Adds a bookmark named "view N" behind the others. This and what follows throw InputError where the file cannot
    /// be written; what they change is changed for this run all the same. A file that could not be used is kept beside
    /// it, as FILE.broken.
    void add(Camera const& camera);
    void rename(std::size_t number, std::string name);
    void remove(std::size_t number);

private:
    void save();

    std::filesystem::path file_;
    glm::dvec3 origin_;
    std::vector<Bookmark> all_;
    std::string complaint_;
    bool is_broken_ = false; ///< the file could not be used
};

} // namespace framelet
