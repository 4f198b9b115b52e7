// Compares pictures of one thing in every format with those of the same in glTF.
#include <array>
#include <functional>
#include <string>
#include <vector>

#include <assimp/Exporter.hpp>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include "server/render/framelet_renderer.h"
#include "server/render/prepared/render_scene.h"
#include "server/scene/motion/animation.h"
#include "server/scene/scene_import.h"
#include "tests/scene/gltf_writer.h"

namespace framelet {
namespace {

using Face = std::array<std::uint32_t, 4>;

/// A box on a plate, which it throws a shadow on: each square with corners of its own.
struct Thing {
    std::vector<glm::dvec3> corners;
    std::vector<Face> faces;
    Vec3 color{0.5f, 0.1f, 0.2f}; ///< linear

    explicit Thing(glm::dvec3 const& at = glm::dvec3(0), double size = 1) {
        add_box({-2, -0.2, -2}, {2, 0, 2});
        add_box({-0.7, 0, -0.5}, {0.4, 1, 0.6});
        for (glm::dvec3& corner : corners) {
            corner = at + size * corner;
        }
    }

    void add_box(glm::dvec3 const& low, glm::dvec3 const& high) {
        for (int axis = 0; axis < 3; ++axis) {
            for (bool const is_high : {false, true}) {
                int const u = (axis + 1) % 3, v = (axis + 2) % 3;
                auto const first = static_cast<std::uint32_t>(corners.size());
                for (auto const& [a, b] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
                    glm::dvec3 corner;
                    corner[axis] = is_high ? high[axis] : low[axis];
                    corner[u] = a == 0 ? low[u] : high[u];
                    corner[v] = b == 0 ? low[v] : high[v];
                    corners.push_back(corner);
                }
                faces.push_back(is_high ? Face{first, first + 1, first + 2, first + 3}
                                        : Face{first, first + 3, first + 2, first + 1});
            }
        }
    }

    /// Text of all corners and faces, each with words around it.
    std::string text(std::string const& before_corner, std::string const& after_corner, std::string const& before_face,
                     std::uint32_t first = 0) const {
        std::string out;
        for (glm::dvec3 const& c : corners) {
            std::array<char, 128> line{};
            std::snprintf(line.data(), line.size(), "%.9g %.9g %.9g", c.x, c.y, c.z);
            out += before_corner + line.data() + after_corner + "\n";
        }
        for (Face const& face : faces) {
            out += before_face;
            for (std::uint32_t const corner : face) {
                out += " " + std::to_string(corner + first);
            }
            out += "\n";
        }
        return out;
    }
};

std::filesystem::path write_gltf(TemporaryFolder const& folder, Thing const& thing) {
    GltfWriter writer;
    std::vector<float> positions;
    std::vector<std::uint16_t> indices;
    for (glm::dvec3 const& c : thing.corners) {
        positions.insert(positions.end(), {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)});
    }
    for (Face const& f : thing.faces) {
        for (std::size_t const k : {0, 1, 2, 0, 2, 3}) {
            indices.push_back(static_cast<std::uint16_t>(f[k]));
        }
    }
    writer.array(positions, "VEC3");
    writer.array(indices, "SCALAR", GltfWriter::u16);
    std::string const color = std::to_string(thing.color.x) + "," + std::to_string(thing.color.y) + "," +
                              std::to_string(thing.color.z) + ",1";
    return folder.write("thing.gltf",
                        writer.json(one_mesh(R"("attributes":{"POSITION":0},"indices":1,"material":0)",
                                             R"(,"materials":[{"doubleSided":true,"pbrMetallicRoughness":{)"
                                             R"("metallicFactor":0,"baseColorFactor":[)" +
                                                 color + "]}}]")));
}

Picture picture_of(std::filesystem::path const& file) {
    Scene const scene = import_scene(file);
    RenderScene const rendered(scene, std::nullopt);
    Camera const camera = default_camera(scene_bounds(scene, evaluate_pose(scene, {}, 0)));
    return render_picture(rendered, camera, {160, 120}, 0, 2);
}

int most_different(Picture const& a, Picture const& b) {
    int most = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        most = std::max(most, std::abs(int{a.rgba[i]} - int{b.rgba[i]}));
    }
    return most;
}

/// Pixels in shadow: the picture has something to compare.
std::size_t count_dark(Picture const& picture) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
        count += picture.rgba[i] < 90;
    }
    return count;
}

constexpr int most_off = 2; // of 255

std::string const ply_head = "element vertex 48\nproperty double x\nproperty double y\nproperty double z\n";
std::string const ply_faces = "element face 12\nproperty list uchar int vertex_indices\n";

TEST(Formats, WrittenByHandLookAsInGltf) {
    TemporaryFolder const folder;
    Thing const thing;
    Thing grey;
    grey.color = Vec3(0.6f);
    Picture const wanted = picture_of(write_gltf(folder, thing));
    Picture const wanted_grey = picture_of(write_gltf(folder, grey));
    EXPECT_GT(count_dark(wanted), 100u);
    folder.write("a.mtl", "newmtl m\nKd 0.5 0.1 0.2\nPr 1\n");
    std::string stl = "solid s\n";
    for (Face const& f : thing.faces) {
        for (auto const& [b, c] : {std::pair(1, 2), std::pair(2, 3)}) {
            stl += "facet normal 0 0 0\nouter loop\n";
            for (int const k : {0, b, c}) {
                glm::dvec3 const& at = thing.corners[f[static_cast<std::size_t>(k)]];
                stl +=
                    "vertex " + std::to_string(at.x) + " " + std::to_string(at.y) + " " + std::to_string(at.z) + "\n";
            }
            stl += "endloop\nendfacet\n";
        }
    }
    std::string const colored = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    for (auto const& [name, text, expected] :
         {std::tuple("a.obj", "mtllib a.mtl\nusemtl m\n" + thing.text("v ", "", "f", 1), &wanted),
          std::tuple("colors.obj", thing.text("v ", " 0.7353570 0.3491902 0.4845292", "f", 1), &wanted),
          std::tuple("a.stl", stl + "endsolid s\n", &wanted_grey),
          std::tuple("a.ply",
                     "ply\nformat ascii 1.0\n" + ply_head + ply_faces + "end_header\n" + thing.text("", "", "4"),
                     &wanted_grey),
          std::tuple("colors.ply",
                     "ply\nformat ascii 1.0\n" + ply_head + colored + ply_faces + "end_header\n" +
                         thing.text("", " 188 89 124", "4"),
                     &wanted),
          std::tuple("a.off", "OFF\n48 12 0\n" + thing.text("", "", "4"), &wanted_grey)}) {
        EXPECT_LE(most_different(picture_of(folder.write(name, text)), *expected), most_off) << name;
    }
}

TEST(Formats, ThatAssimpWritesLookAsInGltf) {
    TemporaryFolder const folder;
    Thing const thing;
    Picture const wanted = picture_of(write_gltf(folder, thing));
    aiScene scene;
    scene.mRootNode = new aiNode("root");
    scene.mRootNode->mMeshes = new unsigned[1]{0};
    scene.mRootNode->mNumMeshes = 1;
    scene.mMeshes = new aiMesh* [1] { new aiMesh };
    scene.mNumMeshes = 1;
    scene.mMaterials = new aiMaterial* [1] { new aiMaterial };
    scene.mNumMaterials = 1;
    aiColor3D const color(thing.color.x, thing.color.y, thing.color.z);
    scene.mMaterials[0]->AddProperty(&color, 1, AI_MATKEY_COLOR_DIFFUSE);
    aiMesh& mesh = *scene.mMeshes[0];
    mesh.mName = "thing";
    mesh.mPrimitiveTypes = aiPrimitiveType_POLYGON;
    mesh.mNumVertices = static_cast<unsigned>(thing.corners.size());
    mesh.mVertices = new aiVector3D[thing.corners.size()];
    for (std::size_t i = 0; i < thing.corners.size(); ++i) {
        Vec3 const c(thing.corners[i]);
        mesh.mVertices[i] = aiVector3D(c.x, c.y, c.z);
    }
    mesh.mNumFaces = static_cast<unsigned>(thing.faces.size());
    mesh.mFaces = new aiFace[thing.faces.size()];
    for (std::size_t f = 0; f < thing.faces.size(); ++f) {
        Face const& face = thing.faces[f];
        mesh.mFaces[f].mNumIndices = 4;
        mesh.mFaces[f].mIndices = new unsigned[4]{face[0], face[1], face[2], face[3]};
    }
    for (auto const& [format, ending] :
         {std::pair("collada", "dae"), std::pair("fbxa", "fbx"), std::pair("3ds", "3ds"), std::pair("x", "x"),
          std::pair("x3d", "x3d"), std::pair("assbin", "assbin"), std::pair("obj", "obj")}) {
        std::filesystem::path const file = folder.path() / (std::string("exported.") + ending);
        ASSERT_EQ(Assimp::Exporter().Export(&scene, format, file.string(), 0), aiReturn_SUCCESS) << format;
        EXPECT_LE(most_different(picture_of(file), wanted), most_off) << format;
    }
}

TEST(Formats, WhatIsFarAwayOrTinyLooksTheSame) {
    TemporaryFolder const folder;
    auto const picture = [&](Thing const& thing) {
        return picture_of(folder.write("a.obj", thing.text("v ", "", "f", 1)));
    };
    Picture const wanted = picture(Thing());
    EXPECT_GT(count_dark(wanted), 100u);
    EXPECT_LE(most_different(picture(Thing({0, 0, 0}, 1e-5)), wanted), most_off) << "tiny";
    EXPECT_LE(most_different(picture(Thing({0, 0, 0}, 1e4)), wanted), most_off) << "large";
    for (glm::dvec3 const& at :
         {glm::dvec3(2000, 0, 0), glm::dvec3(-30000, 2, 60000), glm::dvec3(1842022, 10, -5173301)}) {
        EXPECT_LE(most_different(picture(Thing(at)), wanted), most_off) << at.x << " m";
    }
}

} // namespace
} // namespace framelet
