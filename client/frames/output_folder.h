// The folder that a file is to be written into.
#pragma once

#include <filesystem>

namespace framelet {

/// Makes the folder of that file where there is none. Throws InputError where that fails.
void make_folder_of(std::filesystem::path const& file);

} // namespace framelet
