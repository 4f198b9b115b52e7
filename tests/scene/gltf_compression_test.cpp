// Meshes that Draco or meshoptimizer have compressed show as those that they were made of.
#include "server/scene/scene_import.h"

#include <algorithm>
#include <numeric>

#include <draco/compression/encode.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "common/error.h"
#include "gltf_writer.h"

namespace framelet {
namespace {

std::string lines_of(Scene const& scene) {
    return std::accumulate(scene.warnings.begin(), scene.warnings.end(), std::string(),
                           [](std::string const& text, std::string const& line) { return text + line + "\n"; });
}

Scene import_text(std::string const& text, std::uint64_t megabytes = 64) {
    TemporaryFolder const folder;
    ImportOptions options;
    options.memory_bytes = megabytes << 20;
    return import_scene(folder.write("a.gltf", text), {}, options);
}

std::vector<float> const square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
std::vector<Vec3> const square_corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
std::vector<std::array<std::uint32_t, 3>> const square_triangles{{0, 1, 2}, {0, 2, 3}};

std::size_t triangles_of(Scene const& scene) {
    std::size_t count = 0;
    for (Mesh const& mesh : scene.meshes) {
        count += count_triangles(mesh);
    }
    return count;
}

// Draco

/// Adds an attribute of four vertices; returns its number.
template <typename T>
std::uint32_t add(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data, int components,
                  std::vector<T> const& values) {
    draco::GeometryAttribute attribute;
    auto const bytes = static_cast<std::int64_t>(components * sizeof(T));
    attribute.Init(type, nullptr, static_cast<std::int8_t>(components), data, false, bytes, 0);
    int const id = mesh.AddAttribute(attribute, true, 4);
    for (std::uint32_t i = 0; i < 4; ++i) {
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                              &values[i * static_cast<std::size_t>(components)]);
    }
    return mesh.attribute(id)->unique_id();
}

/// The square with colours and influences, compressed without loss. `ids`: how the file names its attributes.
std::vector<std::uint8_t> draco_square(std::string& ids) {
    draco::Mesh mesh;
    mesh.set_num_points(4);
    ids = R"("POSITION":)" +
          std::to_string(add(mesh, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, square)) +
          R"(,"COLOR_0":)" +
          std::to_string(add(mesh, draco::GeometryAttribute::COLOR, draco::DT_UINT8, 3,
                             std::vector<std::uint8_t>{255, 0, 51, 0, 0, 0, 0, 0, 0, 0, 0, 255})) +
          R"(,"JOINTS_0":)" +
          std::to_string(add(mesh, draco::GeometryAttribute::GENERIC, draco::DT_UINT16, 4,
                             std::vector<std::uint16_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0})) +
          R"(,"WEIGHTS_0":)" +
          std::to_string(add(mesh, draco::GeometryAttribute::GENERIC, draco::DT_FLOAT32, 4,
                             std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}));
    for (auto const& [a, b, c] : square_triangles) {
        mesh.AddFace({draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)});
    }
    draco::Encoder encoder;
    encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
    return {buffer.data(), buffer.data() + buffer.size()};
}

/// A file with that square, of which the bytes are these, and a triangle as it is.
std::string draco_file(std::vector<std::uint8_t> const& bytes, std::string const& ids) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    int const view = writer.view(bytes);
    auto const without_view = [&](int component, int count, char const* type, char const* more = "") {
        return writer.accessor(R"("componentType":)" + std::to_string(component) + R"(,"count":)" +
                               std::to_string(count) + R"(,"type":")" + type + "\"" + more);
    };
    std::string const attributes = R"("POSITION":)" + std::to_string(without_view(GltfWriter::f32, 4, "VEC3")) +
                                   R"(,"COLOR_0":)" +
                                   std::to_string(without_view(GltfWriter::u8, 4, "VEC3", R"(,"normalized":true)")) +
                                   R"(,"JOINTS_0":)" + std::to_string(without_view(GltfWriter::u16, 4, "VEC4")) +
                                   R"(,"WEIGHTS_0":)" + std::to_string(without_view(GltfWriter::f32, 4, "VEC4"));
    std::string const indices = std::to_string(without_view(GltfWriter::u16, 6, "SCALAR"));
    return writer.json(
        R"("extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"],)"
        R"("nodes":[{"mesh":0},{"mesh":1}],"meshes":[{"primitives":[{"attributes":{)" +
        attributes + R"(},"indices":)" + indices + R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":)" +
        std::to_string(view) + R"(,"attributes":{)" + ids +
        R"(}}}}]},{"primitives":[{"attributes":{"POSITION":0}}]}])");
}

TEST(GltfDraco, AMeshIsAsItWas) {
    std::string ids;
    std::vector<std::uint8_t> const bytes = draco_square(ids);
    Scene const scene = import_text(draco_file(bytes, ids));
    EXPECT_EQ(lines_of(scene), "");
    Primitive const& p = scene.meshes.at(0).primitives.at(0);
    ASSERT_EQ(p.triangles.size(), 2u);
    for (std::size_t t = 0; t < 2; ++t) {
        for (std::size_t c = 0; c < 3; ++c) { // flat shading gives each corner its vertex
            std::uint32_t const vertex = p.triangles[t][c];
            std::uint32_t const corner = square_triangles[t][c];
            EXPECT_EQ(p.positions[vertex], square_corners[corner]);
            EXPECT_EQ(p.colors[vertex], corner == 0   ? Vec4(1, 0, 0.2f, 1)
                                        : corner == 3 ? Vec4(0, 0, 1, 1)
                                                      : Vec4(0, 0, 0, 1));
            EXPECT_EQ(p.influences[vertex].joints[0], corner == 1 ? 1 : 0);
            EXPECT_EQ(p.influences[vertex].weights[0], 1);
        }
    }
}

TEST(GltfDraco, BrokenBytesCostTheirPrimitive) {
    std::string ids;
    std::vector<std::uint8_t> const whole = draco_square(ids);
    int broken = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        for (std::uint8_t const value : {std::uint8_t(0), std::uint8_t(0x7f), std::uint8_t(0xff)}) {
            std::vector<std::uint8_t> bytes = whole;
            bytes[i] = value;
            Scene const scene = import_text(draco_file(bytes, ids));
            EXPECT_GE(triangles_of(scene), 1u) << "the other one is shown";
            broken += triangles_of(scene) == 1 ? 1 : 0;
        }
        Scene const scene =
            import_text(draco_file({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(i)}, ids));
        EXPECT_EQ(triangles_of(scene), 1u) << i;
        EXPECT_NE(lines_of(scene).find("mesh 0: "), std::string::npos) << lines_of(scene);
    }
    EXPECT_GT(broken, 20);
    Scene const scene = import_text(draco_file(whole, R"("POSITION":77)"));
    EXPECT_EQ(triangles_of(scene), 1u) << "its positions are in no view, and not in Draco's data";
}

// meshoptimizer

struct Compressed {
    std::string bytes;
    std::size_t count, stride;
    std::string mode, filter;
};

Compressed compressed_vertices(void const* values, std::size_t count, std::size_t stride, std::string filter = "NONE") {
    std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(count, stride));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), values, count, stride));
    return {{out.begin(), out.end()}, count, stride, "ATTRIBUTES", std::move(filter)};
}

Compressed compressed_triangles(std::vector<std::uint16_t> const& order) {
    std::vector<unsigned char> out(meshopt_encodeIndexBufferBound(order.size(), 4));
    out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), order.data(), order.size()));
    return {{out.begin(), out.end()}, order.size(), 2, "TRIANGLES", "NONE"};
}

Compressed compressed_indices(std::vector<std::uint16_t> const& order) {
    std::vector<unsigned char> out(meshopt_encodeIndexSequenceBound(order.size(), 4));
    out.resize(meshopt_encodeIndexSequence(out.data(), out.size(), order.data(), order.size()));
    return {{out.begin(), out.end()}, order.size(), 2, "INDICES", "NONE"};
}

std::string base64(std::string const& bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
        }
    }
    return text;
}

/// A file whose views are of a buffer without data, and compressed; its accessors are these. Mesh 0 is of them, mesh 1
/// of a triangle of its own.
std::string meshopt_file(std::vector<Compressed> const& parts, std::string const& accessors,
                         std::string const& primitive, std::string const& name = "EXT_meshopt_compression") {
    std::string bytes(reinterpret_cast<char const*>(triangle_positions.data()), 36);
    std::string views = R"({"buffer":0,"byteLength":36})";
    std::size_t plain = 0;
    for (Compressed const& part : parts) {
        std::size_t const length = part.count * part.stride;
        views += R"(,{"buffer":1,"byteOffset":)" + std::to_string(plain) + R"(,"byteLength":)" +
                 std::to_string(length) +
                 (part.mode == "ATTRIBUTES" ? R"(,"byteStride":)" + std::to_string(part.stride) : "") +
                 R"(,"extensions":{")" + name + R"(":{"buffer":0,"byteOffset":)" + std::to_string(bytes.size()) +
                 R"(,"byteLength":)" + std::to_string(part.bytes.size()) + R"(,"byteStride":)" +
                 std::to_string(part.stride) + R"(,"count":)" + std::to_string(part.count) + R"(,"mode":")" +
                 part.mode + R"(","filter":")" + part.filter + R"("}}})";
        plain += length;
        bytes += part.bytes;
        bytes.resize((bytes.size() + 3) / 4 * 4);
    }
    return R"({"asset":{"version":"2.0"},"extensionsUsed":[")" + name + R"("],"extensionsRequired":[")" + name +
           R"("],"buffers":[{"byteLength":)" + std::to_string(bytes.size()) +
           R"(,"uri":"data:application/octet-stream;base64,)" + base64(bytes) + R"("},{"byteLength":)" +
           std::to_string(plain) + R"(,"extensions":{")" + name + R"(":{"fallback":true}}}],"bufferViews":[)" + views +
           R"(],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)" + accessors +
           R"(],"nodes":[{"mesh":0},{"mesh":1}],"meshes":[{"primitives":[{)" + primitive +
           R"(}]},{"primitives":[{"attributes":{"POSITION":0}}]}]})";
}

std::string const square_accessors = R"({"bufferView":1,"componentType":5126,"count":4,"type":"VEC3"},)"
                                     R"({"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"})";
std::string const square_primitive = R"("attributes":{"POSITION":1},"indices":2)";
std::vector<std::uint16_t> const square_order{0, 1, 2, 0, 2, 3};

TEST(GltfMeshopt, VerticesAndIndicesAreAsTheyWere) {
    for (Compressed const& order : {compressed_triangles(square_order), compressed_indices(square_order)}) {
        for (char const* const name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
            Scene const scene = import_text(meshopt_file({compressed_vertices(square.data(), 4, 12), order},
                                                         square_accessors, square_primitive, name));
            EXPECT_EQ(lines_of(scene), "");
            Primitive const& p = scene.meshes.at(0).primitives.at(0);
            ASSERT_EQ(p.triangles.size(), 2u);
            for (std::size_t t = 0; t < 2; ++t) {
                std::vector<Vec3> found, right;
                for (std::size_t c = 0; c < 3; ++c) {
                    found.push_back(p.positions[p.triangles[t][c]]);
                    right.push_back(square_corners[square_triangles[t][c]]);
                }
                // Where a triangle begins is the encoder's choice.
                std::rotate(found.begin(), std::ranges::find(found, right[0]), found.end());
                EXPECT_EQ(found, right);
            }
        }
    }
}

TEST(GltfMeshopt, FiltersAreUndone) {
    std::vector<float> const normals{0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.6f, 0, 0.8f, 0};
    std::vector<std::uint32_t> octahedral(4);
    meshopt_encodeFilterOct(octahedral.data(), 4, 4, 8, normals.data());
    std::vector<std::uint32_t> exponential(12);
    meshopt_encodeFilterExp(exponential.data(), 4, 12, 15, square.data());
    Scene const scene = import_text(meshopt_file(
        {compressed_vertices(exponential.data(), 4, 12, "EXPONENTIAL"), compressed_indices(square_order),
         compressed_vertices(octahedral.data(), 4, 4, "OCTAHEDRAL")},
        square_accessors + R"(,{"bufferView":3,"componentType":5120,"normalized":true,"count":4,"type":"VEC3"})",
        R"("attributes":{"POSITION":1,"NORMAL":3},"indices":2)"));
    EXPECT_EQ(lines_of(scene), "");
    Primitive const& p = scene.meshes.at(0).primitives.at(0);
    EXPECT_EQ(p.positions, square_corners);
    for (std::size_t i = 0; i < 4; ++i) {
        Vec3 const right(normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]);
        EXPECT_NEAR(glm::distance(p.normals.at(i), right), 0, 0.02f) << i;
    }
}

TEST(GltfMeshopt, WhatIsWrongCostsItsPrimitive) {
    auto const with = [](auto const& change) {
        std::vector<Compressed> parts{compressed_vertices(square.data(), 4, 12), compressed_triangles(square_order)};
        change(parts);
        return import_text(meshopt_file(parts, square_accessors, square_primitive));
    };
    std::vector<std::pair<std::string, std::function<void(std::vector<Compressed>&)>>> const faults{
        {"compressed bytes are broken", [](auto& parts) { parts[0].bytes.resize(10); }},
        {"compressed bytes are broken", [](auto& parts) { parts[0].bytes[0] = 'x'; }},
        {"compressed bytes are broken", [](auto& parts) { parts[1].bytes.clear(); }},
        {"cannot be decoded: mode 'COLOURS'", [](auto& parts) { parts[0].mode = "COLOURS"; }},
        {"filter 'OCTAHEDRAL'", [](auto& parts) { parts[0].filter = "OCTAHEDRAL"; }},
        {"filter 'FANCY'", [](auto& parts) { parts[0].filter = "FANCY"; }},
        {"5 elements of 2 bytes", [](auto& parts) { parts[1].count = 5; }},
        {"elements of 3 bytes", [](auto& parts) { parts[1].stride = 3; }},
        {"elements of 0 bytes", [](auto& parts) { parts[0].stride = 0; }},
        {"elements of 260 bytes", [](auto& parts) { parts[0].stride = 260; }},
    };
    for (auto const& [part, change] : faults) {
        Scene const scene = with(change);
        EXPECT_EQ(triangles_of(scene), 1u) << part;
        EXPECT_NE(lines_of(scene).find(part), std::string::npos) << part << ": " << lines_of(scene);
    }
    EXPECT_THROW(with([](auto& parts) { parts[0].count = 100'000'000; }), InputError) << "more than its memory";
}

TEST(GltfMeshopt, BytesThatFlipGiveASceneOrAnError) {
    std::string const whole = compressed_vertices(square.data(), 4, 12).bytes;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::vector<Compressed> parts{compressed_vertices(square.data(), 4, 12), compressed_triangles(square_order)};
        parts[0].bytes[i] = static_cast<char>(~parts[0].bytes[i]);
        EXPECT_GE(triangles_of(import_text(meshopt_file(parts, square_accessors, square_primitive))), 1u);
    }
}

} // namespace
} // namespace framelet
