#include "server/scene/mesh/mesh_import.h"

#include <assimp/scene.h>

#include "common/error.h"
#include "server/scene/assimp/assimp_parts.h"
#include "server/scene/mesh/mtl_text.h"
#include "server/scene/reading/file_bytes.h"
#include "server/scene/reading/file_ending.h"

namespace framelet {
namespace {

/// Bytes of memory that a byte of a file becomes, roughly. A file that cannot fit is thus refused before it is read.
constexpr std::uint64_t memory_per_file_byte = 8;

std::uint64_t bytes_of(PolygonSoup const& soup) {
    auto const bytes = [](auto const& values) { return values.capacity() * sizeof(values[0]); };
    return bytes(soup.positions) + bytes(soup.uvs) + bytes(soup.normals) + bytes(soup.colors) + bytes(soup.corners) +
           bytes(soup.faces);
}

/// Gives polygons without a material one: white under colours of vertices, else grey.
void add_default_material(PolygonSoup& soup, MaterialList& materials) {
    bool const has_colors = !soup.colors.empty();
    Index const index = static_cast<Index>(materials.all.size());
    bool is_used = false;
    for (PolygonSoup::Face& face : soup.faces) {
        is_used = is_used || face.material == none;
        face.material = face.material == none ? index : face.material;
    }
    if (is_used) {
        materials.all.push_back(std::make_unique<aiMaterial>());
        if (has_colors) {
            aiColor3D const white(1, 1, 1);
            materials.all.back()->AddProperty(&white, 1, AI_MATKEY_COLOR_DIFFUSE);
        }
    }
}

/// Puts the materials into an aiScene, which owns them.
void give(MaterialList&& materials, aiScene& scene) {
    scene.mNumMaterials = static_cast<unsigned>(materials.all.size());
    scene.mMaterials = new aiMaterial*[materials.all.size()];
    for (std::size_t m = 0; m < materials.all.size(); ++m) {
        scene.mMaterials[m] = materials.all[m].release();
    }
}

} // namespace

void MeshReading::tell(std::size_t bytes_read, std::size_t bytes) {
    std::uint64_t const taken = bytes_of(soup);
    if (taken > reserved) {
        budget.reserve(taken - reserved, 1);
        reserved = taken;
    }
    progress("reading", bytes == 0 ? 1 : static_cast<double>(bytes_read) / static_cast<double>(bytes));
}

bool is_mesh_file(std::string const& extension) {
    return extension == ".obj" || extension == ".ply" || extension == ".stl";
}

Scene import_mesh(std::filesystem::path const& file, SceneFolder const& folder, ImportBudget& budget,
                  Progress const& progress) {
    Scene scene;
    MaterialList materials;
    progress("reading", 0);
    MeshReading reading{file.filename().string(), folder, budget, progress, scene.warnings, materials};
    {
        RegularFile const opened(file);
        if (!opened) {
            throw InputError("it cannot be read: " + opened.problem());
        }
        ImportBudget(budget).reserve(opened.bytes(), memory_per_file_byte);
        std::vector<std::byte> const bytes = read_file(opened, file.string(), budget);
        std::string const extension = lower_extension(file);
        auto* const read = extension == ".obj" ? read_obj : extension == ".ply" ? read_ply : read_stl;
        read(text_of(bytes), reading);
        reading.tell(bytes.size(), bytes.size());
        scene.is_truncated = reading.is_truncated;
    }
    add_default_material(reading.soup, materials);
    add_soup(std::move(reading.soup), file.stem().string(), budget, scene, progress);
    aiScene owner;
    give(std::move(materials), owner);
    import_assimp_materials(owner, folder, budget, scene, progress);
    return scene;
}

} // namespace framelet
