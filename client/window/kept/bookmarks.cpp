#include "client/window/kept/bookmarks.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <numbers>

#include <nlohmann/json.hpp>

#include "client/window/kept/user_files.h"
#include "common/error.h"

namespace framelet {

namespace {

using Json = nlohmann::ordered_json;

constexpr double degrees = 180 / std::numbers::pi;
constexpr std::size_t longest_name = 60;

/// The number that is written with no more digits than it takes to read the same float again.
double shortest(float value) {
    std::array<char, 32> text{};
    auto const written = std::to_chars(text.data(), text.data() + text.size(), value);
    double out = value;
    std::from_chars(text.data(), written.ptr, out);
    return out;
}

Json vector_json(Vec3 const& v, glm::dvec3 const& from = glm::dvec3(0)) {
    return {from.x + shortest(v.x), from.y + shortest(v.y), from.z + shortest(v.z)};
}

Json pose_json(Camera const& camera, glm::dvec3 const& origin) {
    return {{"position", vector_json(camera.position, origin)},
            {"target", vector_json(camera.position + camera.forward(), origin)},
            {"up", vector_json(camera.up())}};
}

Json camera_json(Camera const& camera, glm::dvec3 const& origin) {
    Json out = pose_json(camera, origin);
    if (camera.projection == Projection::orthographic) {
        out["orthographic_height"] = shortest(camera.vertical_extent);
    } else {
        out["fov_degrees"] = shortest(static_cast<float>(camera.vertical_extent * degrees));
    }
    return out;
}

/// Reads a bookmark: what camera files do not have is taken out before the rest is read as one.
Bookmark read_bookmark(Json entry, std::string const& file, glm::dvec3 const& origin) {
    Bookmark out;
    if (entry.is_object() && entry.contains("name") && entry["name"].is_string()) {
        out.name = entry["name"].get<std::string>().substr(0, longest_name);
        entry.erase("name");
    }
    CameraPath const path = parse_camera_path(entry.dump(), file);
    if (path.keys.size() != 1) {
        throw InputError("camera file " + file + ": a bookmark must be a still camera");
    }
    out.camera = path.at(0, origin);
    return out;
}

/// The text of a file of bookmarks: {"cameras": [{"name": ..., and as in a camera file}, ...]}.
std::string bookmarks_text(std::vector<Bookmark> const& bookmarks, glm::dvec3 const& origin) {
    Json cameras = Json::array();
    for (Bookmark const& bookmark : bookmarks) {
        Json entry{{"name", bookmark.name}};
        entry.update(camera_json(bookmark.camera, origin));
        cameras.push_back(std::move(entry));
    }
    return Json{{"cameras", std::move(cameras)}}.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Reads such a text. Throws InputError; `name` of the file is for its message.
std::vector<Bookmark> parse_bookmarks(std::string const& text, std::string const& name, glm::dvec3 const& origin) {
    Json const document = Json::parse(text, nullptr, false);
    if (!document.is_object() || !document.contains("cameras") || !document["cameras"].is_array() ||
        document["cameras"].size() > Bookmarks::most) {
        throw InputError("camera file " + name + ": there must be an object with an array \"cameras\"");
    }
    std::vector<Bookmark> out;
    for (Json const& entry : document["cameras"]) {
        out.push_back(read_bookmark(entry, name, origin));
    }
    return out;
}

} // namespace

std::string camera_file_text(Camera const& camera, CameraMoment const& moment, glm::dvec3 const& origin) {
    Json out = camera_json(camera, origin);
    if (moment.scene_time) {
        out["scene_time"] = *moment.scene_time;
    }
    if (moment.paused) {
        out["paused"] = *moment.paused;
    }
    if (moment.exposure_ev) {
        out["exposure"] = shortest(*moment.exposure_ev);
    }
    return out.dump() + "\n";
}

Bookmarks::Bookmarks(std::filesystem::path file, std::filesystem::path const& older, glm::dvec3 const& origin)
    : file_(std::move(file)), origin_(origin) {
    for (std::filesystem::path const& from : {file_, older}) {
        try {
            if (auto const text = read_user_file(from)) {
                all_ = parse_bookmarks(*text, from.string(), origin);
                return;
            }
        } catch (InputError const& error) {
            complaint_ = std::string(error.what()) + "; bookmarks are left out";
            is_broken_ = from == file_;
            return;
        }
    }
}

void Bookmarks::add(Camera const& camera) {
    if (all_.size() >= most) {
        throw InputError("there are " + std::to_string(most) + " bookmarks already: remove one first");
    }
    // The least number that is free: names stay unlike each other after some have been removed.
    int number = 1;
    auto const name = [&] { return "view " + std::to_string(number); };
    while (std::ranges::any_of(all_, [&](Bookmark const& b) { return b.name == name(); })) {
        ++number;
    }
    all_.push_back({name(), camera});
    save();
}

void Bookmarks::rename(std::size_t number, std::string name) {
    if (number < all_.size()) {
        all_[number].name = std::move(name);
        save();
    }
}

void Bookmarks::remove(std::size_t number) {
    if (number < all_.size()) {
        all_.erase(all_.begin() + static_cast<std::ptrdiff_t>(number));
        save();
    }
}

void Bookmarks::save() {
    if (std::exchange(is_broken_, false)) {
        std::filesystem::path kept = file_;
        kept += ".broken";
        std::error_code ignored; // what cannot be kept is written over
        std::filesystem::rename(file_, kept, ignored);
    }
    write_user_file(file_, bookmarks_text(all_, origin_));
}

BookmarkFiles bookmark_files(std::string const& scene_name, std::uint64_t scene_source) {
    if (config_folder().empty()) {
        return {};
    }
    std::filesystem::path const folder = config_folder() / "cameras";
    auto const file = [&](std::uint64_t source) { return folder / (file_stem_of_scene(scene_name, source) + ".json"); };
    return {file(scene_source), scene_source == 0 ? std::filesystem::path() : file(0)};
}

} // namespace framelet
