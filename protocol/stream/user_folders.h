// Folders for files of the user who runs a program, however bare the environment is that it was started with. Out:
// folders, in the order in which they are to be tried; whoever writes takes the first that can be had, whoever reads
// the first in which there is something.
#pragma once

#include <filesystem>
#include <vector>

namespace framelet {

/// Folders for what is of no use once the machine is off: under $XDG_RUNTIME_DIR or /run/user/UID, if that is this
/// user's alone to write, then `state_folders`.
std::vector<std::filesystem::path> runtime_folders();
/// Folders for what is remembered: under $XDG_STATE_HOME or ~/.local/state, then one under /tmp.
std::vector<std::filesystem::path> state_folders();

/// True where the folder is this user's and nobody else may write there.
bool is_private_folder(std::filesystem::path const& folder);
/// Makes the folder for this user alone, and what is above it, where they do not exist. False where it is not private
/// then.
bool make_private_folder(std::filesystem::path const& folder);

} // namespace framelet
