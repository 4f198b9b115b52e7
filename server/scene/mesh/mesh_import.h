// Reads files of polygons (OBJ, PLY, STL) line by line, or element by element: what cannot be read costs no more than
// itself. In: a path. Out: a Scene that still has to be finished (scene_finish.h), or an InputError without the file's
// name.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "server/scene/mesh/polygon_soup.h"
#include "server/scene/reading/line_remarks.h"
#include "server/scene/reading/scene_folder.h"

namespace framelet {

struct MaterialList;

/// True for the endings, in lower case, of the formats that are read here.
bool is_mesh_file(std::string const& extension);

Scene import_mesh(std::filesystem::path const& file, SceneFolder const& folder, ImportBudget& budget,
                  Progress const& progress);

/// What a reader of one format is handed, and what it makes.
struct MeshReading {
    std::string name; ///< of the file, for remarks
    SceneFolder const& folder;
    ImportBudget& budget;
    Progress const& progress;
    std::vector<std::string>& warnings;
    MaterialList& materials;
    PolygonSoup soup = {};
    std::uint64_t reserved = 0; ///< bytes, for the soup
    bool is_truncated = false; ///< as of `Scene`

    /// Tells how much of the file has been read, and reserves what has become of it since the last call.
    void tell(std::size_t bytes_read, std::size_t bytes);
};

// In: the bytes of a whole file.
void read_obj(std::string_view text, MeshReading& reading);
void read_ply(std::string_view bytes, MeshReading& reading);
void read_stl(std::string_view bytes, MeshReading& reading);

} // namespace framelet
