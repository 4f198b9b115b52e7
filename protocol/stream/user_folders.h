// Where files of the user who runs a program are, however bare the environment is that it was started with. Out:
// folders, in the order in which they are to be tried; whoever writes takes the first that can be had, whoever reads
// the first in which there is something.
#pragma once

#include <filesystem>
#include <vector>

namespace framelet {

/// For what is of no use once the machine is off: $XDG_RUNTIME_DIR or /run/user/UID, if there is one, then
/// `state_folders`.
std::vector<std::filesystem::path> runtime_folders();
/// For what is remembered: under $XDG_STATE_HOME or ~/.local/state, then one under /tmp.
std::vector<std::filesystem::path> state_folders();

/// True where it is this user's and nobody else may write there.
bool is_private_folder(std::filesystem::path const& folder);
/// Makes it, and what is above it, for this user alone, where it does not exist. False where it is not private then.
bool make_private_folder(std::filesystem::path const& folder);

} // namespace framelet
