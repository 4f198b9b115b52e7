#include "server/scene/scene_list.h"

#include <algorithm>
#include <set>
#include <string>

#include "common/error.h"
#include "server/scene/assimp/assimp_import.h"
#include "server/scene/reading/file_ending.h"

namespace framelet {

std::vector<std::filesystem::path> scene_files_in(std::filesystem::path const& folder) {
    std::set<std::string> endings = assimp_endings();
    endings.insert({".gltf", ".glb"});
    std::vector<std::filesystem::path> files;
    std::error_code code;
    for (std::filesystem::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        std::error_code unknown; // of what a link leads to
        if (endings.contains(lower_extension(entry->path())) && entry->is_regular_file(unknown)) {
            files.push_back(entry->path());
        }
    }
    if (code) {
        throw InputError("cannot read folder '" + folder.string() + "': " + code.message());
    }
    std::ranges::sort(files);
    return files;
}

} // namespace framelet
