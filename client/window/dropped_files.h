// Tells camera files from scene files among what is dropped on the window. In: names. Out: the same, apart.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

namespace framelet {

struct DroppedFiles {
    std::vector<std::string> scenes;
    std::vector<std::string> cameras;
};

/// A camera file ends in .json, in whatever case: no format of scenes does.
inline DroppedFiles sort_dropped(std::vector<std::string> const& files) {
    DroppedFiles out;
    for (std::string const& file : files) {
        std::string ending = std::filesystem::path(file).extension().string();
        std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
        (ending == ".json" ? out.cameras : out.scenes).push_back(file);
    }
    return out;
}

} // namespace framelet
