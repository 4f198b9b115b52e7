// Small files that the window keeps for its user. In: a text. Out: a file that is whole, whenever one looks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace framelet {

/// The folder framelet/ in $XDG_CONFIG_HOME or ~/.config; empty where there is neither.
std::filesystem::path config_folder();

/// The text of a file; nothing where there is no such file. Throws InputError, one line, where there is one that cannot
/// be read, or one of more than a megabyte.
std::optional<std::string> read_user_file(std::filesystem::path const& file);

/// Writes a file, and makes its folder. The file of before stays until the new one is complete. Throws InputError, one
/// line.
void write_user_file(std::filesystem::path const& file, std::string const& text);

/// The name, without an ending, of what is kept for a scene: never one of another folder, never a hidden one, never too
/// long. `scene_source` as in Welcome: scenes of the same name from other files have others; where it is not known (0)
/// the name alone counts.
std::string file_stem_of_scene(std::string const& scene_name, std::uint64_t scene_source);

/// The path of a new file: "framelet-20240131-235959" and `extension`, such as ".png"; with a number before that where
/// there is such a file.
std::filesystem::path new_file_name(std::filesystem::path const& folder, std::string const& extension);

} // namespace framelet
