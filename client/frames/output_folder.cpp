#include "client/frames/output_folder.h"

#include "common/error.h"

namespace framelet {

namespace fs = std::filesystem;

void make_folder_of(fs::path const& file) {
    fs::path const folder = file.parent_path();
    std::error_code error;
    if (!folder.empty() && !fs::is_directory(folder)) {
        fs::create_directories(folder, error);
        if (error) {
            throw InputError("cannot make the folder " + folder.string() + ": " + error.message());
        }
    }
}

} // namespace framelet
