// Polygons as mesh files have them (OBJ, PLY, STL), and the triangles that become of them. In: corners that name
// positions, texture coordinates, normals and colours. Out: a node with a mesh.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "server/scene/reading/import_budget.h"
#include "server/scene/reading/progress.h"
#include "server/scene/scene.h"

namespace framelet {

struct PolygonSoup {
    static constexpr std::uint32_t nothing = ~0u;
    /// `Face::smoothing` of files that do not say which edges are sharp: those above a crease angle are.
    static constexpr std::uint32_t by_angle = ~0u;

    /// Indices; `nothing` where the file has none.
    struct Corner {
        std::uint32_t position = nothing, uv = nothing, normal = nothing, color = nothing;
    };
    struct Face {
        std::uint32_t first = 0; ///< of its corners; the last one is before the next face's first
        Index material = none;
        std::uint32_t smoothing = by_angle; ///< smooth towards faces with the same number; 0: flat
    };

    std::vector<glm::dvec3> positions; ///< not finite where the file's cannot be read
    std::vector<Vec2> uvs; ///< v goes upwards
    std::vector<Vec3> normals; ///< of any length; those without one are taken for missing
    std::vector<Vec4> colors; ///< linear
    std::vector<Corner> corners;
    std::vector<Face> faces;
    std::size_t points = 0, lines = 0, curves = 0; ///< of the file, that are left out

    void add_face(std::span<Corner const> of, Index material, std::uint32_t smoothing) {
        faces.push_back({static_cast<std::uint32_t>(corners.size()), material, smoothing});
        corners.insert(corners.end(), of.begin(), of.end());
    }
    bool is_usable(std::uint32_t position) const;
};

/// Adds a node of this name with all polygons as triangles, one primitive a material, and says what is left out.
/// Missing normals are made, alike corners joined. Throws InputError where there are no polygons.
void add_soup(PolygonSoup&& soup, std::string const& name, ImportBudget& budget, Scene& scene,
              Progress const& progress);

} // namespace framelet
