// A file of what a fuzz target is to read. For fuzz targets only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace framelet {

/// A file that goes with this object. Its name is this process's own, the same each time.
class InputFile {
public:
    InputFile(std::uint8_t const* data, std::size_t size, std::string const& ending)
        : path_(std::filesystem::temp_directory_path() / ("framelet-fuzz-" + std::to_string(::getpid()) + ending)) {
        std::ofstream(path_, std::ios::binary)
            .write(reinterpret_cast<char const*>(data), static_cast<std::streamsize>(size));
    }
    ~InputFile() { std::filesystem::remove(path_); }
    InputFile(InputFile const&) = delete;
    InputFile& operator=(InputFile const&) = delete;

    std::filesystem::path const& path() const { return path_; }

private:
    std::filesystem::path const path_;
};

} // namespace framelet
