#include "client/viewer/bookmark_list.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "client/core/camera/camera_path.h"
#include "client/core/camera/camera_text.h"
#include "client/viewer/commands.h"
#include "common/error.h"

namespace framelet {

namespace {

using Json = nlohmann::json;

constexpr std::size_t longest_name = 60;
/// Depth of the text beyond which nothing of it is read: what is nested deeper takes stack to be written again.
constexpr int most_depth = 8;

/// Reads a bookmark: what camera files do not have is taken out before the rest is read as one.
Bookmark read_bookmark(Json entry, std::string const& name, glm::dvec3 const& origin) {
    Bookmark out;
    if (entry.is_object() && entry.contains("name") && entry["name"].is_string()) {
        out.name = entry["name"].get<std::string>().substr(0, longest_name);
        entry.erase("name");
    }
    CameraPath const path = parse_camera_path(entry.dump(), name);
    if (path.keys.size() != 1) {
        throw InputError("camera file " + name + ": a bookmark must be a still camera");
    }
    out.camera = path.at(0, origin);
    return out;
}

} // namespace

std::string bookmarks_text(std::vector<Bookmark> const& bookmarks, glm::dvec3 const& origin) {
    Json cameras = Json::array();
    for (Bookmark const& bookmark : bookmarks) {
        Json entry{{"name", bookmark.name}};
        entry.update(Json::parse(camera_file_text(bookmark.camera, {}, origin)));
        cameras.push_back(std::move(entry));
    }
    return Json{{"cameras", std::move(cameras)}}.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<Bookmark> parse_bookmarks(std::string const& text, std::string const& name, glm::dvec3 const& origin) {
    auto const is_shallow = [](int depth, Json::parse_event_t, Json const&) { return depth <= most_depth; };
    Json const document = Json::parse(text, is_shallow, false);
    if (!document.is_object() || !document.contains("cameras") || !document["cameras"].is_array() ||
        document["cameras"].size() > most_bookmarks) {
        throw InputError("camera file " + name + ": there must be an object with an array \"cameras\"");
    }
    std::vector<Bookmark> out;
    for (Json const& entry : document["cameras"]) {
        out.push_back(read_bookmark(entry, name, origin));
    }
    return out;
}

void add_bookmark(std::vector<Bookmark>& all, Camera const& camera) {
    if (all.size() >= most_bookmarks) {
        throw InputError("there are " + std::to_string(most_bookmarks) + " bookmarks already: remove one first");
    }
    // The least number that is free: names stay unlike each other after some have been removed.
    int number = 1;
    auto const name = [&] { return "view " + std::to_string(number); };
    while (std::ranges::any_of(all, [&](Bookmark const& b) { return b.name == name(); })) {
        ++number;
    }
    all.push_back({name(), camera});
}

std::string bookmark_added_text(std::vector<Bookmark> const& all) {
    int const number = static_cast<int>(all.size()) - 1;
    return "bookmark " + all.back().name + " added" +
           (number < numbered_cameras ? ": " + key_names(numbered(Command::bookmark, number)) + " comes back here"
                                      : "");
}

std::string bookmark_removed_text(std::string const& name) {
    return "bookmark " + name + " removed";
}

} // namespace framelet
