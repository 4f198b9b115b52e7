#include "server/scene/assimp/assimp_import.h"

#include <assimp/DefaultLogger.hpp>
#include <gtest/gtest.h>

#include "common/color.h"
#include "common/error.h"
#include "common/files/picture_writer.h"
#include "gltf_writer.h"
#include "server/scene/assimp/assimp_log.h"
#include "server/scene/motion/animation.h"
#include "server/scene/scene_import.h"

namespace framelet {
namespace {

Material const& material_of(Scene const& scene) {
    return scene.materials.at(static_cast<std::size_t>(scene.meshes.at(0).primitives.at(0).material));
}

/// An OBJ square with one material, of these lines.
Scene square_with(TemporaryFolder const& folder, std::string const& lines) {
    folder.write("a.mtl", "newmtl m\n" + lines);
    return import_scene(folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\n"
                                              "vt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n"));
}

std::string const cube_corners = "-1 -1 -1\n1 -1 -1\n1 1 -1\n-1 1 -1\n-1 -1 1\n1 -1 1\n1 1 1\n-1 1 1\n";
std::string const cube_faces = "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 0 4 7 3\n";

/// A cube of eight corners, which its faces share; each with these properties of its own.
std::string ply_cube(std::string const& properties, std::string const& values) {
    std::string corners = cube_corners;
    for (std::size_t at = 0; (at = corners.find('\n', at)) != std::string::npos; at += values.size() + 1) {
        corners.insert(at, values);
    }
    return "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n" +
           properties + "element face 6\nproperty list uchar int vertex_indices\nend_header\n" + corners + cube_faces;
}

/// How many corners of triangles have a normal that is not that of their own face.
std::size_t count_bent(Scene const& scene) {
    std::size_t count = 0;
    for (Primitive const& p : scene.meshes.at(0).primitives) {
        for (auto const& t : p.triangles) {
            Vec3 const face = glm::normalize(
                glm::cross(p.positions[t[1]] - p.positions[t[0]], p.positions[t[2]] - p.positions[t[0]]));
            for (std::uint32_t const corner : t) {
                count += glm::dot(face, p.normals[corner]) < 0.999f;
            }
        }
    }
    return count;
}

TEST(AssimpMend, ColoursThatAFileDoesNotHaveAreNotBlack) {
    TemporaryFolder const folder;
    for (std::string const lines : {"Kd 0.5 0.1 0.2\nPr 0.5\n", "Kd 0.5 0.1 0.2\nPm 0\n", "Pm 0.5\nKd 0.5 0.1 0.2\n",
                                    "Kd 0.5 0.1 0.2\nPr 0.25\nPm 1\nKe 0 0 0\n"}) {
        EXPECT_EQ(material_of(square_with(folder, lines)).base_color, Vec4(0.5f, 0.1f, 0.2f, 1)) << lines;
    }
}

TEST(AssimpMend, ColoursOfVerticesAreDisplayColours) {
    TemporaryFolder const folder;
    Vec3 const wanted(linear_from_srgb_byte(180), linear_from_srgb_byte(90), linear_from_srgb_byte(45));
    std::string const color = " 0.705882 0.352941 0.176471\n";
    std::string const ply = ply_cube("property uchar red\nproperty uchar green\nproperty uchar blue\n", " 180 90 45");
    std::string const obj = "v 0 0 0" + color + "v 1 0 0" + color + "v 0 1 0" + color + "f 1 2 3\n";
    for (auto const& [name, text] : {std::pair("a.ply", ply), std::pair("a.obj", obj)}) {
        Scene const scene = import_scene(folder.write(name, text));
        Primitive const& p = scene.meshes.at(0).primitives.at(0);
        ASSERT_FALSE(p.colors.empty()) << name;
        for (Vec4 const& c : p.colors) {
            Vec3 const shown = Vec3(c) * Vec3(material_of(scene).base_color);
            EXPECT_LT(glm::length(shown - wanted), 1e-3f) << name << ' ' << shown.x << ' ' << shown.y;
            EXPECT_EQ(c.w, 1) << name;
        }
    }
}

TEST(AssimpMend, AMaterialThatAFileNamesTintsTheColoursOfItsVertices) {
    TemporaryFolder const folder;
    folder.write("a.mtl", "newmtl m\nKd 0.5 0.5 0.5\n");
    Scene const scene = import_scene(
        folder.write("a.obj", "mtllib a.mtl\nusemtl m\nv 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 0 1 0 1 1 1\nf 1 2 3\n"));
    EXPECT_EQ(material_of(scene).base_color, Vec4(0.5f, 0.5f, 0.5f, 1));
}

TEST(AssimpMend, NormalsAreThoseOfTheFacesWhereVerticesAreShared) {
    TemporaryFolder const folder;
    EXPECT_EQ(count_bent(import_scene(folder.write("a.ply", ply_cube("", "")))), 0u);
    EXPECT_EQ(count_bent(import_scene(folder.write("a.off", "OFF\n8 6 0\n" + cube_corners + cube_faces))), 0u);
}

TEST(AssimpMend, UnusableNormalsCountAsMissing) {
    TemporaryFolder const folder;
    std::string const names = "property float nx\nproperty float ny\nproperty float nz\n";
    for (std::string const normal : {" 0 0 0", " nan nan nan"}) {
        EXPECT_EQ(count_bent(import_scene(folder.write("a.ply", ply_cube(names, normal)))), 0u) << normal;
    }
    // Two sides of an edge; the file has a normal for one of them alone.
    auto const facet = [](std::string const& normal, std::string const& corners) {
        return "facet normal " + normal + "\nouter loop\n" + corners + "endloop\nendfacet\n";
    };
    std::string const flat = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
    std::string const steep = "vertex 0 0 0\nvertex 0 0 1\nvertex 1 0 0\n";
    for (auto const& [of_flat, of_steep] : {std::pair("0 0 0", "0 0 0"), std::pair("0 0 1", "0 0 0")}) {
        Scene const scene = import_scene(
            folder.write("a.stl", "solid s\n" + facet(of_flat, flat) + facet(of_steep, steep) + "endsolid s\n"));
        EXPECT_EQ(count_bent(scene), 0u) << of_flat << ", " << of_steep;
        ASSERT_EQ(scene.warnings.size(), 1u);
        EXPECT_NE(scene.warnings[0].find("neither what its unit is nor which axis is up"), std::string::npos);
    }
}

TEST(AssimpMend, TextureTransformsOfMaterialsAreKept) {
    TemporaryFolder const folder;
    Picture picture(2, 2);
    picture.rgba.assign(16, 255);
    write_png(folder.path() / "colour map.png", picture);
    // What a corner at (u, v), v upwards, has to look up: u * scale + offset.
    auto const check = [&](std::string const& options, Vec2 const& scale, Vec2 const& offset) {
        Scene const scene = square_with(folder, "Kd 1 1 1\nmap_Kd " + options + " colour map.png\n");
        TextureUse const& use = material_of(scene).base_color_texture;
        ASSERT_NE(use.texture, none) << options;
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
        Primitive const& p = scene.meshes.at(0).primitives.at(0);
        for (std::size_t i = 0; i < p.positions.size(); ++i) {
            Vec2 const wanted = Vec2(p.positions[i]) * scale + offset;
            Vec2 const found = transform_uv(use, p.uv[0][i]);
            EXPECT_LT(glm::length(Vec2(found.x, 1 - found.y) - wanted), 1e-5f) << options << ' ' << found.y;
        }
    };
    check("-s 2 3 1", {2, 3}, {0, 0});
    check("-o 0.5 0.25 0", {1, 1}, {0.5f, 0.25f});
    check("-o 0.5 0.25 -s 0.5 2.5 1", {0.5f, 2.5f}, {0.5f, 0.25f});
    check("-s 2", {2, 1}, {0, 0});
    check("-bm 0.3 -blendu on -mm 0 1 -s 2 2 2 -clamp off", {2, 2}, {0, 0});
}

TEST(AssimpMend, AMaterialLineThatCannotBeReadCostsThatLine) {
    TemporaryFolder const folder;
    // Valid, though nothing is made of it:
    for (std::string const line :
         {"aniso 0.5", "anisor 0.1", "Prfl 0", "Pccns 1-1", "Ks spectral a.rfl", "Ka xyz 1 1 1", "illum 2", "Ni 1.45",
          "refl -type sphere n.png", "map_aat on", "# Kd 1 1 1", "wood 3", "Tf 1 1 1", "sharpness 60", "Ps 0.2",
          "Pcr 0.03", "d 1 # opaque", ""}) {
        Scene const scene = square_with(folder, "Kd 0.5 0.1 0.2\n" + line + "\n");
        EXPECT_EQ(material_of(scene).base_color, Vec4(0.5f, 0.1f, 0.2f, 1)) << line;
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    }
    EXPECT_EQ(material_of(square_with(folder, "Kd 1 0 0\nd -halo 0.5\n")).base_color.w, 0.5f);
    EXPECT_EQ(material_of(square_with(folder, "Kd 1 0 0\nTr 0.25\n")).base_color.w, 0.75f);
    EXPECT_EQ(material_of(square_with(folder, "Kd 0.5\n")).base_color, Vec4(0.5f, 0.5f, 0.5f, 1));
    for (std::string const line : {"Kd spectral red.rfl 1", "Kd one two three", "Ns", "d 0,5", "Pr rough", "map_Kd",
                                   "map_Kd -s 2", "newmtl", "Kd 1e400 0 0", "Kd"}) {
        Scene const scene = square_with(folder, "Kd 0.5 0.1 0.2\n" + line + "\n");
        EXPECT_EQ(material_of(scene).base_color, Vec4(0.5f, 0.1f, 0.2f, 1)) << line;
        ASSERT_EQ(scene.warnings.size(), 1u) << line;
        EXPECT_EQ(scene.warnings[0], "a.mtl, line 3: '" + line + "' cannot be read; passed over");
    }
}

/// A tower four units high along z, `unit` centimetres each.
std::string fbx_tower(int up, int front, int front_sign, std::string const& unit) {
    auto const number = [](std::string const& name, int value) {
        return "\t\tP: \"" + name + "\", \"int\", \"Integer\", \"\"," + std::to_string(value) + "\n";
    };
    return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}\n"
           "GlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n" +
           number("UpAxis", up) + number("UpAxisSign", 1) + number("FrontAxis", front) +
           number("FrontAxisSign", front_sign) + number("CoordAxis", 0) + number("CoordAxisSign", 1) +
           "\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\"," + unit +
           "\n\t}\n}\nObjects:  {\n\tGeometry: 1000, \"Geometry::tower\", \"Mesh\" {\n\t\tVertices: *24 {\n\t\t\ta: "
           "0,0,0,1,0,0,1,1,0,0,1,0,0,0,4,1,0,4,1,1,4,0,1,4\n\t\t}\n\t\tPolygonVertexIndex: *24 {\n\t\t\ta: "
           "0,3,2,-2,4,5,6,-8,0,1,5,-5,2,3,7,-7,1,2,6,-6,0,4,7,-4\n\t\t}\n\t\tGeometryVersion: 124\n\t}\n"
           "\tModel: 2000, \"Model::tower\", \"Mesh\" {\n\t\tVersion: 232\n\t\tShading: T\n\t}\n}\n"
           "Connections:  {\n\tC: \"OO\",2000,0\n\tC: \"OO\",1000,2000\n}\n";
}

TEST(AssimpMend, FbxFilesSayWhichAxisIsUpAndWhatAUnitIs) {
    TemporaryFolder const folder;
    auto const check = [&](std::string const& text, Vec3 const& low, Vec3 const& high) {
        Scene const scene = import_scene(folder.write("a.fbx", text));

        Bounds const bounds = scene_bounds(scene, evaluate_pose(scene, {}, 0));
        EXPECT_LT(glm::length(bounds.lower - low), 1e-5f)
            << bounds.lower.x << ' ' << bounds.lower.y << ' ' << bounds.lower.z;
        EXPECT_LT(glm::length(bounds.upper - high), 1e-5f)
            << bounds.upper.x << ' ' << bounds.upper.y << ' ' << bounds.upper.z;
    };
    check(fbx_tower(2, 1, -1, "1"), {0, 0, -0.01f}, {0.01f, 0.04f, 0});
    check(fbx_tower(2, 1, -1, "100"), {0, 0, -1}, {1, 4, 0});
    check(fbx_tower(1, 2, 1, "1"), {0, 0, 0}, {0.01f, 0.01f, 0.04f});
    check(fbx_tower(1, 2, 1, "2.54"), {0, 0, 0}, {0.0254f, 0.0254f, 0.1016f});
}

TEST(AssimpMend, WhatAssimpPassesOverIsSaidPlainly) {
    EXPECT_EQ(loss_in("Warn,  T0: Collada: too many texture coordinate sets. Skipping.\n"),
              "some texture coordinates are passed over");
    EXPECT_EQ(loss_in("Warn,  T0: 3DS: Skipping FOV animation track. This is not supported"),
              "some of its animation is passed over");
    EXPECT_EQ(loss_in("Error, T0: NFF: Encountered unsupported ID: NURBS"), "NURBS surfaces and curves are not shown");
    EXPECT_EQ(loss_in("Warn,  T0: FBX-DOM: unknown enum value"), "");
    AssimpLog const log;
    for (char const* const line :
         {"LWO2: Unsupported texture map mode: RESET", "LWO2: Skipping UV channel 'a'", "all is well"}) {
        Assimp::DefaultLogger::get()->warn(line);
        Assimp::DefaultLogger::get()->warn(line);
    }
    EXPECT_EQ(log.losses(), (std::vector<std::string>{"some of its textures are passed over",
                                                      "some texture coordinates are passed over"}));
}

TEST(AssimpMend, APolygonWithBrokenCornersCostsThatPolygon) {
    TemporaryFolder const folder;
    Scene const scene =
        import_scene(folder.write("a.off", "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\nnan 0 0\n4 0 1 2 3\n3 0 1 4\n"));
    EXPECT_EQ(count_triangles(scene.meshes.at(0)), 2u);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(scene.warnings[0], "1 polygon left out for corners that are not numbers");
    for (auto const& [name, why] : {std::pair("a.dae", "Assimp cannot read it"), std::pair("a.blend", "a.blend")}) {
        try {
            import_scene(folder.write(name, "nothing of the kind"));
            ADD_FAILURE() << "loaded";
        } catch (InputError const& error) {
            EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
        }
    }
}

TEST(AssimpMend, PointsAndLinesAreSaidToBeLeftOut) {
    TemporaryFolder const folder;
    Scene const scene =
        import_scene(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\nl 2 3\nl 3 1\n"));
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(scene.warnings[0], "3 lines are not shown: only surfaces are");
    try {
        import_scene(folder.write(
            "a.ply", "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
                     "end_header\n0 0 0\n1 0 0\n"));
        ADD_FAILURE() << "loaded";
    } catch (InputError const& error) {
        EXPECT_NE(std::string(error.what()).find("it has no surfaces, and only these are shown"), std::string::npos)
            << error.what();
    }
}

} // namespace
} // namespace framelet
