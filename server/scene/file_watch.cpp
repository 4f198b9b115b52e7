#include "server/scene/file_watch.h"

#include <sys/stat.h>

namespace framelet {

FileWatch::Stamp FileWatch::stamp_of(std::filesystem::path const& file) {
    struct stat found {};
    if (::stat(file.c_str(), &found) != 0) {
        return {};
    }
    return {found.st_dev, found.st_ino, found.st_size, found.st_mtim.tv_sec, found.st_mtim.tv_nsec};
}

void FileWatch::watch(std::span<std::filesystem::path const> files) {
    std::map<std::filesystem::path, Stamp> stamps;
    for (std::filesystem::path const& file : files) {
        auto const known = stamps_.find(file);
        stamps.emplace(file, known != stamps_.end() ? known->second : stamp_of(file));
    }
    stamps_ = std::move(stamps);
}

bool FileWatch::look(Time now) {
    for (auto& [file, stamp] : stamps_) {
        if (Stamp const found = stamp_of(file); found != stamp) {
            stamp = found;
            changed_ = now;
        }
    }
    if (changed_ && now - *changed_ >= quiet) {
        changed_.reset();
        return true;
    }
    return false;
}

} // namespace framelet
