// Reads the material files of .obj scenes line by line, so that a line which cannot be read costs that line: Assimp
// gives up the scene, and leaves out how textures are scaled and moved. In: the text of a file. Out: what Assimp reads
// of it, and what it does not.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <assimp/material.h>

struct aiScene;

namespace framelet {

struct MtlRemarks {
    struct Transform {
        std::string material;
        aiTextureType texture;
        aiUVTransform transform;
    };
    std::vector<Transform> transforms;
    std::vector<std::string> warnings;
};

/// The statements of `text` that materials are made of, each with words that Assimp 5.2 reads. What cannot be read is
/// added to the warnings, with the file's `name` and the line; statements of no use here are left out without one.
std::string clean_mtl(std::string_view text, std::string const& name, MtlRemarks& remarks);

/// Gives the scene's materials the transforms of their textures.
void add_transforms(aiScene const& scene, MtlRemarks const& remarks);

} // namespace framelet
