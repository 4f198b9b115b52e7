#include "client/window/kept/bookmarks.h"

#include <utility>

#include "client/window/kept/user_files.h"
#include "common/error.h"

namespace framelet {

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
    add_bookmark(all_, camera);
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
