#include "server/scene/scene_import.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "gltf_writer.h"

namespace framelet {
namespace {

Primitive import_primitive(GltfWriter const& writer, std::string const& primitive) {
    TemporaryFolder const folder;
    return import_scene(folder.write("a.gltf", writer.json(one_mesh(primitive)))).meshes.at(0).primitives.at(0);
}

std::string import_error(GltfWriter const& writer, std::string const& primitive) {
    try {
        import_primitive(writer, primitive);
    } catch (InputError const& error) {
        return error.what();
    }
    return "no error";
}

TEST(GltfAccessor, InterleavedAttributesWithStride) {
    GltfWriter writer;
    std::vector<float> both;
    for (std::size_t i = 0; i < 3; ++i) {
        both.insert(both.end(), triangle_positions.begin() + static_cast<std::ptrdiff_t>(3 * i),
                    triangle_positions.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
        both.insert(both.end(), {0, 0, 2}); // normals come out as unit vectors
    }
    int const view = writer.view(both, 24);
    std::string const text =
        R"("bufferView":)" + std::to_string(view) + R"(,"componentType":5126,"count":3,"type":"VEC3")";
    writer.accessor(text);
    writer.accessor(text + R"(,"byteOffset":12)");
    Primitive const p = import_primitive(writer, R"("attributes":{"POSITION":0,"NORMAL":1})");
    EXPECT_EQ(p.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(p.normals, std::vector<Vec3>(3, Vec3(0, 0, 1)));
    EXPECT_EQ(p.triangles.size(), 1u);
}

TEST(GltfAccessor, SparseReplacesSomeElements) {
    GltfWriter writer;
    int const base = writer.view(triangle_positions);
    int const indices = writer.view(std::vector<std::uint16_t>{1});
    int const values = writer.view(std::vector<float>{5, 6, 7});
    writer.accessor(R"("bufferView":)" + std::to_string(base) +
                    R"(,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":)" +
                    std::to_string(indices) + R"(,"componentType":5123},"values":{"bufferView":)" +
                    std::to_string(values) + "}}");
    EXPECT_EQ(import_primitive(writer, R"("attributes":{"POSITION":0})").positions,
              (std::vector<Vec3>{{0, 0, 0}, {5, 6, 7}, {0, 1, 0}}));
}

TEST(GltfAccessor, SparseWithoutBaseStartsFromZero) {
    GltfWriter writer;
    int const indices = writer.view(std::vector<std::uint8_t>{0, 2});
    int const values = writer.view(std::vector<float>{1, 0, 0, 0, 2, 0});
    writer.accessor(R"("componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":)" +
                    std::to_string(indices) + R"(,"componentType":5121},"values":{"bufferView":)" +
                    std::to_string(values) + "}}");
    EXPECT_EQ(import_primitive(writer, R"("attributes":{"POSITION":0})").positions,
              (std::vector<Vec3>{{1, 0, 0}, {0, 0, 0}, {0, 2, 0}}));
}

TEST(GltfAccessor, NormalisedIntegers) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    std::string const normalized = R"(,"normalized":true)";
    // Each element has four bytes, so that the stride is a multiple of four.
    int const u8 = writer.view(std::vector<std::uint8_t>{255, 0, 51, 0, 0, 255, 0, 0, 102, 0, 0, 0}, 4);
    writer.accessor(R"("bufferView":)" + std::to_string(u8) + R"(,"componentType":5121,"count":3,"type":"VEC3")" +
                    normalized);
    writer.array(std::vector<std::uint16_t>{0, 65535, 13107, 0, 0, 0}, "VEC2", GltfWriter::u16, normalized);
    writer.array(std::vector<std::int16_t>{32767, -32767, -32768, 0, 0, 0}, "VEC2", GltfWriter::i16, normalized);
    Primitive const p =
        import_primitive(writer, R"("attributes":{"POSITION":0,"COLOR_0":1,"TEXCOORD_0":2,"TEXCOORD_1":3})");
    EXPECT_EQ(p.colors[0], Vec4(1, 0, 0.2f, 1));
    EXPECT_EQ(p.colors[2], Vec4(0.4f, 0, 0, 1));
    EXPECT_EQ(p.uv[0][0], Vec2(0, 1));
    EXPECT_FLOAT_EQ(p.uv[0][1].x, 0.2f);
    EXPECT_EQ(p.uv[1][0], Vec2(1, -1));
    EXPECT_EQ(p.uv[1][1], Vec2(-1, 0)) << "-32768 is clamped";
}

TEST(GltfAccessor, QuantisedPositionsKeepTheirValue) {
    GltfWriter writer;
    int const view = writer.view(std::vector<std::int8_t>{0, 0, 0, 0, 100, 0, 0, 0, 0, -100, 0, 0}, 4);
    writer.accessor(R"("bufferView":)" + std::to_string(view) + R"(,"componentType":5120,"count":3,"type":"VEC3")");
    EXPECT_EQ(import_primitive(writer, R"("attributes":{"POSITION":0})").positions[2], Vec3(0, -100, 0));
}

class IndexType : public testing::TestWithParam<int> {};

TEST_P(IndexType, IsRead) {
    GltfWriter writer;
    writer.array(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
    std::vector<std::uint32_t> const order{0, 1, 2, 0, 2, 3};
    switch (GetParam()) {
    case GltfWriter::u8:
        writer.array(std::vector<std::uint8_t>(order.begin(), order.end()), "SCALAR", GetParam());
        break;
    case GltfWriter::u16:
        writer.array(std::vector<std::uint16_t>(order.begin(), order.end()), "SCALAR", GetParam());
        break;
    default:
        writer.array(order, "SCALAR", GetParam());
    }
    writer.array(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    Primitive const p = import_primitive(writer, R"("attributes":{"POSITION":0,"NORMAL":2},"indices":1)");
    EXPECT_EQ(p.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
}

INSTANTIATE_TEST_SUITE_P(All, IndexType, testing::Values(GltfWriter::u8, GltfWriter::u16, GltfWriter::u32));

TEST(GltfAccessor, OutOfRangeIsRefused) {
    struct Case {
        char const* accessor;
        char const* message;
    };
    for (Case const& c : std::vector<Case>{
             {R"("bufferView":7,"componentType":5126,"count":3,"type":"VEC3")", "buffer view 7"},
             {R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC3")", "reaches beyond its buffer view"},
             {R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3","byteOffset":4)", "reaches beyond"},
             {R"("bufferView":0,"componentType":5126,"count":18446744073709551615,"type":"VEC3")", "reaches beyond"},
             {R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3","byteOffset":18446744073709551612)",
              "reaches"},
             {R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC2")", "components"},
             {R"("bufferView":0,"componentType":5124,"count":3,"type":"VEC3")", "component type"},
             {R"("componentType":5126,"count":999999999999,"type":"VEC3")", "no buffer view"},
             {R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":)"
              R"({"bufferView":1,"componentType":5123},"values":{"bufferView":0}})",
              "sparse index 9"},
             {R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,"indices":)"
              R"({"bufferView":1,"componentType":5123},"values":{"bufferView":0}})",
              "sparse indices"},
             {R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":)"
              R"({"bufferView":1,"componentType":5123},"values":{"bufferView":0,"byteOffset":-4}})",
              "sparse values"},
         }) {
        GltfWriter writer;
        writer.view(triangle_positions);
        writer.view(std::vector<std::uint16_t>{9});
        writer.accessor(c.accessor);
        std::string const error = import_error(writer, R"("attributes":{"POSITION":0})");
        EXPECT_NE(error.find(c.message), std::string::npos) << c.accessor << ": " << error;
    }
}

TEST(GltfAccessor, ViewBeyondItsBufferIsRefused) {
    TemporaryFolder const folder;
    auto const file = folder.write(
        "a.gltf",
        R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"data:application/octet-stream;base64,)"
        R"(AAAAAA=="}],"bufferViews":[{"buffer":0,"byteOffset":2,"byteLength":36}],"accessors":[{"bufferView":0,)"
        R"("componentType":5126,"count":3,"type":"VEC3"}],)" +
            one_mesh(R"("attributes":{"POSITION":0})") + "}");
    EXPECT_THROW(import_scene(file), InputError);
}

TEST(GltfAccessor, VertexIndexOutOfRangeIsRefused) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    writer.array(std::vector<std::uint16_t>{0, 1, 3}, "SCALAR", GltfWriter::u16);
    std::string const error = import_error(writer, R"("attributes":{"POSITION":0},"indices":1)");
    EXPECT_NE(error.find("vertex index 3 is out of range"), std::string::npos) << error;
}

TEST(GltfAccessor, AttributeOfAnotherLengthIsRefused) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    writer.array(std::vector<float>{0, 0}, "VEC2");
    std::string const error = import_error(writer, R"("attributes":{"POSITION":0,"TEXCOORD_0":1})");
    EXPECT_NE(error.find("TEXCOORD_0 has 1 entries for 3 vertices"), std::string::npos) << error;
}

} // namespace
} // namespace framelet
