// Tells the kind of a file by its name.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

namespace framelet {

/// The file name's ending with its dot, in lower case.
inline std::string lower_extension(std::filesystem::path const& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 32) : c; });
    return extension;
}

} // namespace framelet
