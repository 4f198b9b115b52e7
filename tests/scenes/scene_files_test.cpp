#include "scenes/scene_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include "scenes/gltf/gltf_writer.h"

namespace framelet {
namespace {

constexpr std::size_t largest_committed_file = 1'000'000;
constexpr std::size_t largest_sum = 12'000'000;

std::string generate(SceneEntry const& entry) {
    GltfDocument document = entry.make();
    document.name = entry.name;
    return write_glb(document);
}

std::filesystem::path committed_file(SceneEntry const& entry) {
    return std::filesystem::path(FRAMELET_SOURCE_DIR) / "scenes" / (entry.name + ".glb");
}

std::string read_file(std::filesystem::path const& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

tinygltf::Model parse(std::string const& bytes) {
    tinygltf::TinyGLTF loader;
    tinygltf::Model model;
    std::string error;
    std::string warning;
    bool const fine =
        loader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<unsigned char const*>(bytes.data()),
                                    static_cast<unsigned int>(bytes.size()));
    EXPECT_TRUE(fine) << error;
    EXPECT_EQ(error, "");
    EXPECT_EQ(warning, "");
    return model;
}

unsigned char const* data_of(tinygltf::Model const& model, tinygltf::Accessor const& accessor) {
    tinygltf::BufferView const& view = model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
    return model.buffers.at(static_cast<std::size_t>(view.buffer)).data.data() + view.byteOffset + accessor.byteOffset;
}

tinygltf::Accessor const& accessor_at(tinygltf::Model const& model, int index) {
    return model.accessors.at(static_cast<std::size_t>(index));
}

std::vector<float> floats_of(tinygltf::Model const& model, int index) {
    tinygltf::Accessor const& accessor = accessor_at(model, index);
    EXPECT_EQ(accessor.componentType, TINYGLTF_COMPONENT_TYPE_FLOAT);
    std::vector<float> values(accessor.count * static_cast<std::size_t>(tinygltf::GetNumComponentsInType(
                                                   static_cast<std::uint32_t>(accessor.type))));
    std::memcpy(values.data(), data_of(model, accessor), values.size() * sizeof(float));
    EXPECT_TRUE(std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }));
    return values;
}

std::uint32_t largest_index(tinygltf::Model const& model, tinygltf::Accessor const& accessor) {
    bool const narrow = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    std::size_t const size = narrow ? 2 : 4;
    std::uint32_t largest = 0;
    for (std::size_t i = 0; i < accessor.count; ++i) {
        std::uint32_t value = 0; // little-endian, as the file and every machine this runs on
        std::memcpy(&value, data_of(model, accessor) + i * size, size);
        largest = std::max(largest, value);
    }
    return largest;
}

/// Four bytes a vertex, as JOINTS_0 and WEIGHTS_0 have them.
std::vector<int> bytes_of(tinygltf::Model const& model, int index) {
    tinygltf::Accessor const& accessor = accessor_at(model, index);
    EXPECT_EQ(accessor.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE);
    EXPECT_EQ(accessor.type, TINYGLTF_TYPE_VEC4);
    unsigned char const* const data = data_of(model, accessor);
    return {data, data + accessor.count * 4};
}

/// Checks that weights sum to one and that their joints are some of the skin's.
void check_joint_weights(tinygltf::Model const& model, tinygltf::Primitive const& primitive, std::size_t vertices,
                         std::size_t joint_count) {
    std::vector<int> const joints = bytes_of(model, primitive.attributes.at("JOINTS_0"));
    std::vector<int> const weights = bytes_of(model, primitive.attributes.at("WEIGHTS_0"));
    ASSERT_EQ(joints.size(), vertices * 4);
    ASSERT_EQ(weights.size(), vertices * 4);
    EXPECT_LT(*std::max_element(joints.begin(), joints.end()), static_cast<int>(joint_count));
    for (std::size_t i = 0; i < weights.size(); i += 4) {
        ASSERT_EQ(weights[i] + weights[i + 1] + weights[i + 2] + weights[i + 3], 255);
    }
}

void check_skins(tinygltf::Model const& model) {
    for (tinygltf::Node const& node : model.nodes) {
        if (node.skin >= 0) {
            tinygltf::Skin const& skin = model.skins.at(static_cast<std::size_t>(node.skin));
            EXPECT_EQ(floats_of(model, skin.inverseBindMatrices).size(), skin.joints.size() * 16);
            for (tinygltf::Primitive const& primitive :
                 model.meshes.at(static_cast<std::size_t>(node.mesh)).primitives) {
                std::size_t const vertices = accessor_at(model, primitive.attributes.at("POSITION")).count;
                check_joint_weights(model, primitive, vertices, skin.joints.size());
            }
        }
    }
}

void check_primitive(tinygltf::Model const& model, tinygltf::Primitive const& primitive) {
    std::size_t const vertices = accessor_at(model, primitive.attributes.at("POSITION")).count;
    tinygltf::Accessor const& indices = accessor_at(model, primitive.indices);
    EXPECT_GT(indices.count, 0u);
    EXPECT_EQ(indices.count % 3, 0u);
    EXPECT_LT(largest_index(model, indices), vertices);
    floats_of(model, primitive.attributes.at("POSITION"));
    std::vector<float> const normals = floats_of(model, primitive.attributes.at("NORMAL"));
    ASSERT_EQ(normals.size(), vertices * 3);
    for (std::size_t i = 0; i < normals.size(); i += 3) {
        ASSERT_NEAR(std::hypot(normals[i], normals[i + 1], normals[i + 2]), 1, 1e-4);
    }
    auto const& material = model.materials.at(static_cast<std::size_t>(primitive.material));
    bool const textured = material.pbrMetallicRoughness.baseColorTexture.index >= 0;
    EXPECT_EQ(primitive.attributes.contains("TEXCOORD_0"), textured);
    if (textured) {
        std::vector<float> const uv = floats_of(model, primitive.attributes.at("TEXCOORD_0"));
        EXPECT_EQ(uv.size(), vertices * 2);
        EXPECT_LT(std::abs(*std::max_element(uv.begin(), uv.end())), 1000);
    }
    if (primitive.attributes.contains("COLOR_0")) {
        EXPECT_EQ(accessor_at(model, primitive.attributes.at("COLOR_0")).count, vertices);
    }
    for (std::map<std::string, int> const& target : primitive.targets) {
        EXPECT_EQ(floats_of(model, target.at("POSITION")).size(), vertices * 3);
        EXPECT_EQ(floats_of(model, target.at("NORMAL")).size(), vertices * 3);
    }
}

/// Numbers in a key of the channel.
std::size_t width_of(tinygltf::Model const& model, tinygltf::AnimationChannel const& channel) {
    if (channel.target_path == "weights") {
        int const mesh = model.nodes.at(static_cast<std::size_t>(channel.target_node)).mesh;
        return model.meshes.at(static_cast<std::size_t>(mesh)).primitives.at(0).targets.size();
    }
    return channel.target_path == "rotation" ? 4 : 3;
}

/// Checks that every key is finite and in order; returns the last time.
double check_animation(tinygltf::Model const& model, tinygltf::Animation const& animation) {
    double last = 0;
    std::set<std::pair<int, std::string>> targets;
    for (tinygltf::AnimationChannel const& channel : animation.channels) {
        EXPECT_TRUE(targets.emplace(channel.target_node, channel.target_path).second) << "animated twice";
        auto const& sampler = animation.samplers.at(static_cast<std::size_t>(channel.sampler));
        std::vector<float> const times = floats_of(model, sampler.input);
        EXPECT_TRUE(std::is_sorted(times.begin(), times.end(), std::less_equal<>())) << "strictly increasing";
        EXPECT_EQ(times.front(), 0);
        last = std::max(last, double(times.back()));
        std::vector<float> const values = floats_of(model, sampler.output);
        std::size_t const width = width_of(model, channel);
        EXPECT_EQ(values.size(), times.size() * width);
        for (std::size_t i = 0; channel.target_path == "rotation" && i < values.size(); i += 4) {
            EXPECT_NEAR(std::hypot(std::hypot(values[i], values[i + 1]), std::hypot(values[i + 2], values[i + 3])), 1,
                        1e-4);
        }
    }
    return last;
}

class SceneFile : public testing::TestWithParam<SceneEntry> {};

TEST_P(SceneFile, IsMadeTheSameTwiceAndAsCommitted) {
    std::string const bytes = generate(GetParam());
    EXPECT_TRUE(bytes == generate(GetParam()));
    EXPECT_EQ(std::filesystem::exists(committed_file(GetParam())), GetParam().committed);
    if (GetParam().committed) {
        EXPECT_TRUE(bytes == read_file(committed_file(GetParam())))
            << "run `framelet-scenes scenes --committed` and commit the files";
        EXPECT_LT(bytes.size(), largest_committed_file);
    }
}

TEST_P(SceneFile, IsAConsistentScene) {
    tinygltf::Model const model = parse(generate(GetParam()));
    EXPECT_EQ(model.cameras.size(), 1u);
    EXPECT_GE(model.lights.size(), 1u);
    ASSERT_EQ(model.animations.size(), 1u);
    EXPECT_NEAR(check_animation(model, model.animations[0]), GetParam().duration, 1e-5);
    for (tinygltf::Mesh const& mesh : model.meshes) {
        SCOPED_TRACE(mesh.name);
        for (tinygltf::Primitive const& primitive : mesh.primitives) {
            check_primitive(model, primitive);
        }
    }
    check_skins(model);
    for (tinygltf::Image const& image : model.images) {
        EXPECT_GE(image.width, 64);
        EXPECT_LE(image.width, 512);
    }
}

INSTANTIATE_TEST_SUITE_P(Table, SceneFile, testing::ValuesIn(scene_table().begin(), scene_table().end()),
                         [](auto const& instance) { return instance.param.name; });

TEST(SceneTable, NamesTheScenesOfTheEvaluation) {
    std::set<std::string> names;
    std::size_t sum = 0;
    for (SceneEntry const& entry : scene_table()) {
        names.insert(entry.name);
        sum += entry.committed ? std::filesystem::file_size(committed_file(entry)) : 0;
    }
    EXPECT_EQ(names,
              (std::set<std::string>{"vehicle_fixed", "vehicle_chase", "vehicle_flyby", "vehicle_approach",
                                     "vehicle_crossing", "windmill", "globe", "terrain", "stop", "flicker", "teleport",
                                     "foliage", "dim", "walker", "flag", "fan", "glass", "interior", "dusk"}));
    EXPECT_LT(sum, largest_sum);
}

TEST(SceneTable, TerrainHasAMillionTriangles) {
    auto const table = scene_table();
    auto const terrain =
        std::find_if(table.begin(), table.end(), [](SceneEntry const& entry) { return entry.name == "terrain"; });
    ASSERT_NE(terrain, table.end());
    EXPECT_GE(drawn_triangles(terrain->make()), 1'000'000u);
}

} // namespace
} // namespace framelet
