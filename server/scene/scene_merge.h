// Makes one scene of several. In: finished scenes, and a word for each that none of the others has. Out: a scene with
// all that is in them, each where its file has it.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "server/scene/scene.h"

namespace framelet {

/// Everything of the scenes, in their order. A name that things of one kind have in more than one scene gets the word
/// of its scene before it, as "house/door". The files that the scenes were read from come first among `files`.
Scene merged_scene(std::vector<Scene> scenes, std::span<std::string const> words);

/// A word for each file: its name without folder and ending, with a number where several are the same.
std::vector<std::string> words_for(std::span<std::filesystem::path const> files);

} // namespace framelet
