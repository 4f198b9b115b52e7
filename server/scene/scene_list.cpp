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
    std::filesystem::directory_iterator const first(folder,
                                                    code); // that this one may not be read is no reason to pass it over
    std::filesystem::recursive_directory_iterator entry;
    if (!code) {
        entry = {folder, std::filesystem::directory_options::skip_permission_denied, code};
    }
    for (std::filesystem::recursive_directory_iterator const end; !code && entry != end; entry.increment(code)) {
        std::error_code unknown; // of what a link leads to
        if (entry->path().filename().string().starts_with('.')) {
            entry.disable_recursion_pending();
        } else if (endings.contains(lower_extension(entry->path())) && entry->is_regular_file(unknown)) {
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
