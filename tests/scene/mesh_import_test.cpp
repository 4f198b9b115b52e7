#include "server/scene/mesh/mesh_import.h"

#include <algorithm>
#include <array>
#include <bit>

#include <gtest/gtest.h>

#include "common/color.h"
#include "common/error.h"
#include "common/files/picture_writer.h"
#include "gltf_writer.h"
#include "server/scene/scene_import.h"

namespace framelet {
namespace {

std::size_t triangles_of(Scene const& scene) {
    return scene.meshes.empty() ? 0 : count_triangles(scene.meshes.front());
}

std::string joined(std::vector<std::string> const& lines) {
    std::string text;
    for (std::string const& line : lines) {
        text += line + "\n";
    }
    return text;
}

Material const& material_of(Scene const& scene, Primitive const& primitive) {
    return scene.materials.at(static_cast<std::size_t>(primitive.material));
}

std::string const square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// The square, and a line of which nothing can be made.
TEST(ObjFile, ABadLineCostsThatLine) {
    TemporaryFolder const folder;
    std::string const face = "f 1 2 3 4\n";
    struct Case {
        std::string line;
        std::string warning;
    };
    for (Case const& c :
         std::vector<Case>{{"f 1 2 x", "a.obj, line 6: 'f 1 2 x' cannot be read; passed over"},
                           {"f 1 2 9", "a.obj, line 6: a polygon names vertex 9 of 4; passed over"},
                           {"f 0 1 2", "a.obj, line 6: 'f 0 1 2' cannot be read; passed over"},
                           {"f -9 -2 -1", "a.obj, line 6: 'f -9 -2 -1' cannot be read; passed over"},
                           {"f 1/7 2/7 3/7",
                            "a.obj, line 6: texture coordinates or normals that the file does not have; passed over"},
                           {"vn 0 up 0", "a.obj, line 6: 'vn 0 up 0' cannot be read; passed over"},
                           {"vt", "a.obj, line 6: 'vt' cannot be read; passed over"},
                           {"s sometimes", "a.obj, line 6: 's sometimes' cannot be read; passed over"},
                           {"<html>", "a.obj, line 6: '<html>' cannot be read; passed over"}}) {
        Scene const scene = import_scene(folder.write("a.obj", square + face + c.line + "\n"));
        EXPECT_GE(triangles_of(scene), 2u) << c.line;
        EXPECT_EQ(joined(scene.warnings), c.warning + "\n");
    }
    for (std::string const line : {"g a b", "o", "# f 1 2 9", "s off", "s 1", "vp 0 1", "lod 3", "usemtl",
                                   "f 1 2 3 # 4", "cstype bezier", "end", "v 1 2 3 1", "vt 0.5", "f 4 3 2\\\n 1"}) {
        Scene const scene = import_scene(folder.write("a.obj", square + face + line + "\n"));
        EXPECT_GE(triangles_of(scene), 2u) << line;
        EXPECT_EQ(joined(scene.warnings), "") << line;
    }
}

TEST(ObjFile, ABadVertexCostsThePolygonsThatHaveIt) {
    TemporaryFolder const folder;
    for (std::string const vertex : {"v 5 nan 0", "v 5 six 7", "v 5", "v 1e300 0 0"}) {
        Scene const scene = import_scene(folder.write("a.obj", square + vertex + "\nf 1 2 5\nf 1 2 3 4\nf 1 5 3\n"));
        EXPECT_EQ(triangles_of(scene), 2u) << vertex;
        EXPECT_EQ(joined(scene.warnings),
                  "a.obj, line 5: '" + vertex +
                      "' cannot be read; passed over\n"
                      "a.obj, line 6: a polygon names vertex 5, which cannot be read; passed over\n"
                      "a.obj, line 8: a polygon names vertex 5, which cannot be read; passed over\n");
    }
}

TEST(ObjFile, ManyBadLinesAreFewWarnings) {
    TemporaryFolder const folder;
    std::string text = square + "f 1 2 3 4\n";
    for (int i = 0; i < 1000; ++i) {
        text += "f 1 2 9\n";
    }
    Scene const scene = import_scene(folder.write("a.obj", text));
    EXPECT_LE(scene.warnings.size(), 100u);
    EXPECT_EQ(scene.warnings.back(), "a.obj: 950 more such lines");
}

TEST(ObjFile, LinesEndAsInAnySystem) {
    TemporaryFolder const folder;
    for (std::string const end : {"\n", "\r\n", "\r"}) {
        std::string text = square + "f 1 2 3 4\nf 1 2 9\n";
        for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size()) {
            text.replace(at, 1, end);
        }
        Scene const scene = import_scene(folder.write("a.obj", "\xef\xbb\xbf" + text));
        EXPECT_EQ(triangles_of(scene), 2u);
        EXPECT_EQ(joined(scene.warnings), "a.obj, line 6: a polygon names vertex 9 of 4; passed over\n");
    }
}

/// Two squares that meet at a right angle, in the given groups.
Scene bent(TemporaryFolder const& folder, std::string const& first, std::string const& second) {
    return import_scene(
        folder.write("a.obj", square + "v 1 0 -1\nv 1 1 -1\n" + first + "f 1 2 3 4\n" + second + "f 2 5 6 3\n"));
}

TEST(ObjFile, SmoothingGroupsSayWhichEdgesAreSharp) {
    TemporaryFolder const folder;
    auto const count_soft = [](Scene const& scene) {
        std::size_t count = 0;
        for (Vec3 const& n : scene.meshes.at(0).primitives.at(0).normals) {
            count += std::abs(n.x - n.z) < 1e-3f && n.x > 0.5f;
        }
        return count;
    };
    EXPECT_EQ(count_soft(bent(folder, "s 1\n", "")), 2u);
    EXPECT_EQ(count_soft(bent(folder, "s 1\n", "s 2\n")), 0u);
    EXPECT_EQ(count_soft(bent(folder, "s off\n", "")), 0u);
    EXPECT_EQ(count_soft(bent(folder, "s 1\n", "s 0\n")), 0u);
    EXPECT_EQ(count_soft(bent(folder, "", "")), 0u) << "above the crease angle";
    Scene const turned = import_scene(folder.write(
        "a.obj", square + "v 2 0 0.2\nv 2 1 0.2\ns 1\nf 1 2 3 4\nf 3 6 5 2\n")); // the second one the other way round
    for (Vec3 const& n : turned.meshes.at(0).primitives.at(0).normals) {
        EXPECT_GT(std::abs(n.z), 0.9f);
    }
}

TEST(ObjFile, ColoursOfVerticesMayBeBytes) {
    TemporaryFolder const folder;
    Scene const scene = import_scene(folder.write("a.obj", "v 0 0 0\nv 1 0 0 255 128 0\nv 0 1 0 255 128 0\nf 1 2 3\n"));
    Primitive const& p = scene.meshes.at(0).primitives.at(0);
    for (std::size_t i = 0; i < 3; ++i) {
        bool const is_plain = p.positions[i].x == 0 && p.positions[i].y == 0;
        EXPECT_NEAR(p.colors.at(i).y, is_plain ? 1 : linear_from_srgb_byte(128), 1e-5f);
    }
    EXPECT_EQ(material_of(scene, p).base_color, Vec4(1));
}

std::string ply_head(std::string const& format, std::string const& more) {
    return "ply\nformat " + format + " 1.0\n" + more + "end_header\n";
}
std::string const vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
std::string const corners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
std::string const faces = "property list uchar int vertex_indices\n";

TEST(PlyFile, ABadLineCostsThatLine) {
    TemporaryFolder const folder;
    auto const scene_of = [&](std::string const& third_face) {
        return import_scene(folder.write("a.ply", ply_head("ascii", vertices + "element face 2\n" + faces) + corners +
                                                      "4 0 1 2 3\n" + third_face + "\n"));
    };
    for (std::string const line : {"3 0 1 9", "3 0 1", "x", "3 0 1 -1", "-3 0 1 2"}) {
        Scene const scene = scene_of(line);
        EXPECT_EQ(triangles_of(scene), 2u) << line;
        EXPECT_EQ(joined(scene.warnings), "a.ply, line 15: a face that cannot be read; passed over\n") << line;
    }
    EXPECT_EQ(joined(scene_of("3 0 1 2").warnings), "");
}

TEST(PlyFile, BinaryOfEitherOrder) {
    TemporaryFolder const folder;
    for (bool const is_big : {false, true}) {
        std::string text = ply_head(is_big ? "binary_big_endian" : "binary_little_endian",
                                    "element vertex 4\nproperty double x\nproperty float y\nproperty short z\n"
                                    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                                    "element face 2\n" +
                                        faces);
        auto const add = [&](auto value) {
            auto bytes = std::bit_cast<std::array<char, sizeof(value)>>(value);
            if (is_big) {
                std::reverse(bytes.begin(), bytes.end());
            }
            text.append(bytes.begin(), bytes.end());
        };
        for (auto const& [x, y] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
            add(static_cast<double>(x));
            add(static_cast<float>(y));
            add(static_cast<std::int16_t>(-3));
            text += std::string("\xff\x80\0", 3);
        }
        for (int const third : {2, 3}) {
            text += '\3';
            for (int const index : {0, 1, third}) {
                add(static_cast<std::int32_t>(index));
            }
        }
        Scene const scene = import_scene(folder.write("a.ply", text));
        EXPECT_EQ(triangles_of(scene), 2u);
        Primitive const& p = scene.meshes.at(0).primitives.at(0);
        EXPECT_EQ(p.positions.at(0).z, -3);
        EXPECT_NEAR(p.colors.at(0).y, linear_from_srgb_byte(128), 1e-5f);
        EXPECT_TRUE(scene.warnings.empty());
        Scene const cut = import_scene(folder.write("a.ply", text.substr(0, text.size() - 5)));
        EXPECT_EQ(triangles_of(cut), 1u);
        EXPECT_EQ(joined(cut.warnings), "the file ends after 1 of 2 of its 'face' elements\n");
        EXPECT_TRUE(cut.is_truncated && !scene.is_truncated);
    }
}

TEST(PlyFile, StripsAreWhole) {
    TemporaryFolder const folder;
    Scene const scene = import_scene(folder.write(
        "a.ply", ply_head("ascii", vertices + "element tristrips 1\nproperty list int int vertex_indices\n") + corners +
                     "11 0 1 3 2 -1 0 1 2 -1 2 3\n"));
    ASSERT_EQ(triangles_of(scene), 3u);
    for (Vec3 const& normal : scene.meshes.at(0).primitives.at(0).normals) {
        EXPECT_EQ(normal, Vec3(0, 0, 1)) << "every second triangle is wound the other way in a strip";
    }
}

TEST(PlyFile, CornersHaveTexturesOfTheirOwn) {
    TemporaryFolder const folder;
    Picture picture(2, 2);
    picture.rgba.assign(16, 255);
    write_png(folder.path() / "a.png", picture);
    write_png(folder.path() / "b c.png", picture);
    Scene const scene = import_scene(
        folder.write("a.ply", ply_head("ascii", "comment TextureFile a.png\ncomment TextureFile b c.png\n" + vertices +
                                                    "element face 2\n" + faces +
                                                    "property list uchar float texcoord\nproperty int texnumber\n") +
                                  corners + "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0.5 0.5 1 1 0 1 1\n"));
    EXPECT_EQ(joined(scene.warnings), "");
    ASSERT_EQ(scene.meshes.at(0).primitives.size(), 2u);
    EXPECT_EQ(scene.images.size(), 2u);
    for (Primitive const& p : scene.meshes[0].primitives) {
        EXPECT_NE(material_of(scene, p).base_color_texture.texture, none);
        EXPECT_EQ(p.positions.size(), 3u);
    }
    Primitive const& second = scene.meshes[0].primitives[1];
    for (std::size_t i = 0; i < 3; ++i) {
        bool const is_origin = second.positions[i] == Vec3(0);
        EXPECT_EQ(second.uv[0].at(i).x, is_origin ? 0.5f : second.positions[i].x) << i;
    }
}

TEST(PlyFile, FacesMayHaveColours) {
    TemporaryFolder const folder;
    Scene const scene = import_scene(
        folder.write("a.ply", ply_head("ascii", vertices + "element face 2\n" + faces +
                                                    "property uchar red\nproperty uchar green\nproperty uchar blue\n") +
                                  corners + "3 0 1 2 255 0 0\n3 0 2 3 0 0 255\n"));
    Primitive const& p = scene.meshes.at(0).primitives.at(0);
    EXPECT_EQ(p.positions.size(), 6u);
    EXPECT_EQ(p.colors.at(p.triangles[0][0]), Vec4(1, 0, 0, 1));
    EXPECT_EQ(p.colors.at(p.triangles[1][0]), Vec4(0, 0, 1, 1));
}

TEST(PlyFile, CloudsOfPointsAndEdgesAreSaid) {
    TemporaryFolder const folder;
    try {
        import_scene(folder.write("a.ply", ply_head("ascii", vertices) + corners));
        ADD_FAILURE() << "loaded";
    } catch (InputError const& error) {
        EXPECT_NE(std::string(error.what()).find("no surfaces, and only these are shown (4 points are not shown"),
                  std::string::npos)
            << error.what();
    }
    Scene const scene = import_scene(
        folder.write("a.ply", ply_head("ascii", vertices + "element face 1\n" + faces +
                                                    "element edge 2\nproperty int vertex1\nproperty int vertex2\n") +
                                  corners + "4 0 1 2 3\n0 1\n1 2\n"));
    EXPECT_EQ(joined(scene.warnings), "2 lines are not shown: only surfaces are\n");
}

/// A binary file of two triangles with these spare bytes.
std::string stl_of(std::string header, std::uint16_t first, std::uint16_t second) {
    header.resize(80, ' ');
    auto const add = [&](auto value) {
        auto const bytes = std::bit_cast<std::array<char, sizeof(value)>>(value);
        header.append(bytes.begin(), bytes.end());
    };
    add(std::uint32_t(2));
    for (std::uint16_t const spare : {first, second}) {
        for (float const value : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) {
            add(value);
        }
        add(spare);
    }
    return header;
}

TEST(StlFile, ColoursOfEitherKind) {
    TemporaryFolder const folder;
    auto const colors = [&](std::string const& text) {
        Primitive const p = import_scene(folder.write("a.stl", text)).meshes.at(0).primitives.at(0);
        std::vector<Vec4> of_triangles;
        for (auto const& triangle : p.triangles) {
            of_triangles.push_back(p.colors.empty() ? Vec4(0) : p.colors[triangle[0]]);
        }
        return of_triangles;
    };
    Vec4 const red(1, 0, 0, 1), blue(0, 0, 1, 1);
    EXPECT_EQ(colors(stl_of("solid", 0x8000 | 31 << 10, 0x8000 | 31)), (std::vector{red, blue}));
    EXPECT_EQ(colors(stl_of(std::string("COLOR=\0\0\xff\xff", 10), 31, 0x8000)), (std::vector{red, blue}));
    EXPECT_EQ(colors(stl_of("x", 0, 0)), std::vector(2, Vec4(0)));
}

TEST(StlFile, WhatCannotBeReadCostsItsTriangle) {
    TemporaryFolder const folder;
    std::string const binary = stl_of("x", 0, 0);
    Scene const cut = import_scene(folder.write("a.stl", binary.substr(0, binary.size() - 1)));
    EXPECT_EQ(triangles_of(cut), 1u);
    EXPECT_NE(joined(cut.warnings).find("the file ends after 1 of 2 triangles"), std::string::npos);
    EXPECT_TRUE(cut.is_truncated);
    std::string const whole =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    std::string broken = whole;
    broken.replace(broken.find("1 0 0"), 5, "1 x 0");
    Scene const text = import_scene(folder.write("a.stl", "solid s\n" + broken + whole + "endsolid s\n"));
    EXPECT_EQ(triangles_of(text), 1u);
    EXPECT_NE(joined(text.warnings).find("a.stl, line 2: a facet that cannot be read; passed over"), std::string::npos);
}

} // namespace
} // namespace framelet
