// The user's own views in a scene, by name, as text. In: cameras. Out: a text of camera files, and back; what is said
// of a change. Where the text is kept is the program's own.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/camera.h"

namespace framelet {

struct Bookmark {
    std::string name;
    Camera camera;
    bool operator==(Bookmark const&) const = default;
};

/// Most bookmarks of one scene.
inline constexpr std::size_t most_bookmarks = 1000;

/// The text {"cameras": [{"name": ..., and as in a camera file}, ...]}. In it positions are as the scene's file has
/// them, in bookmarks they count from the scene's `origin`.
std::string bookmarks_text(std::vector<Bookmark> const& bookmarks, glm::dvec3 const& origin);
/// Reads such a text, whatever it is. Throws InputError, one line; `name` is for that.
std::vector<Bookmark> parse_bookmarks(std::string const& text, std::string const& name, glm::dvec3 const& origin);

/// Adds a bookmark named "view N" behind the others. Throws InputError where there are too many.
void add_bookmark(std::vector<Bookmark>& all, Camera const& camera);
/// Says that the last one has been added, and how to come back to it.
std::string bookmark_added_text(std::vector<Bookmark> const& all);
/// Says that the one of this name has been removed.
std::string bookmark_removed_text(std::string const& name);

} // namespace framelet
