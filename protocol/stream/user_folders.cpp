#include "protocol/stream/user_folders.h"

#include <cstdlib>
#include <string>

#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

namespace framelet {
namespace {

std::filesystem::path const own_name = "framelet";

/// Value of an environment variable; empty where it is not an absolute path: the specification of these variables says
/// to pass it over.
std::filesystem::path path_variable(char const* name) {
    char const* const value = std::getenv(name);
    std::filesystem::path const path = value == nullptr ? "" : value;
    return path.is_absolute() ? path : std::filesystem::path();
}

std::filesystem::path home_folder() {
    std::filesystem::path home = path_variable("HOME");
    if (home.empty()) {
        passwd const* const user = ::getpwuid(::geteuid());
        home = user == nullptr ? "" : user->pw_dir;
    }
    return home;
}

} // namespace

std::vector<std::filesystem::path> runtime_folders() {
    std::vector<std::filesystem::path> folders;
    std::filesystem::path parent = path_variable("XDG_RUNTIME_DIR");
    if (parent.empty()) {
        parent = "/run/user/" + std::to_string(::geteuid());
    }
    if (is_private_folder(parent)) { // not another user's, as under sudo
        folders.push_back(parent / own_name);
    }
    for (auto& folder : state_folders()) {
        folders.push_back(std::move(folder));
    }
    return folders;
}

std::vector<std::filesystem::path> state_folders() {
    std::vector<std::filesystem::path> folders;
    std::filesystem::path parent = path_variable("XDG_STATE_HOME");
    if (parent.empty()) {
        std::filesystem::path const home = home_folder();
        parent = home.is_absolute() ? home / ".local" / "state" : std::filesystem::path();
    }
    if (!parent.empty()) {
        folders.push_back(parent / own_name);
    }
    folders.push_back("/tmp/framelet-" + std::to_string(::geteuid()));
    return folders;
}

bool is_private_folder(std::filesystem::path const& folder) {
    struct stat found {};
    return ::lstat(folder.c_str(), &found) == 0 && S_ISDIR(found.st_mode) && found.st_uid == ::geteuid() &&
           (found.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

bool make_private_folder(std::filesystem::path const& folder) {
    std::error_code ignored; // what could not be made is not private
    std::filesystem::create_directories(folder.parent_path(), ignored);
    ::mkdir(folder.c_str(), S_IRWXU);
    return is_private_folder(folder);
}

} // namespace framelet
