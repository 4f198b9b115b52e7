// Reads the material files of .obj scenes, line by line: a line that cannot be read costs that line. In: the text of a
// file. Out: materials as Assimp keeps them, which `import_assimp_materials` takes.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <assimp/material.h>

#include "server/scene/reading/line_remarks.h"
#include "server/scene/scene.h"

namespace framelet {

struct MaterialList {
    std::vector<std::unique_ptr<aiMaterial>> all;
    std::map<std::string, Index, std::less<>> index_of; ///< by name

    /// The material of this name, which is added where there is none.
    aiMaterial& get(std::string_view name);
};

/// Adds the file's materials. What cannot be read gets a remark; statements that nothing is made of get none.
void read_mtl(std::string_view text, LineRemarks& remarks, MaterialList& materials);

/// Gives the material a texture, as a file names it.
void set_texture(aiMaterial& material, aiTextureType type, std::string_view file);

} // namespace framelet
