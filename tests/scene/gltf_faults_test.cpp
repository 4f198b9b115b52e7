// Faults in glTF files: each costs what it concerns and gives one warning that names it; valid files give none.
#include "server/scene/scene_import.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "common/error.h"
#include "gltf_writer.h"

namespace framelet {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// Triangles that nodes show, each time that they do.
std::size_t shown_triangles(Scene const& scene) {
    std::size_t count = 0;
    for (Node const& node : scene.nodes) {
        count += node.mesh == none ? 0 : count_triangles(scene.meshes[static_cast<std::size_t>(node.mesh)]);
    }
    return count;
}

std::string lines_of(Scene const& scene) {
    std::string text;
    for (std::string const& warning : scene.warnings) {
        text += warning + "\n";
    }
    return text;
}

/// A writer whose accessors are: 0 a triangle, 1 one with a vertex that is no number, 2 indices up to 3, 3 joints up to
/// 3, 4 weights, 5 two keys, 6 two vectors, 7 three zero vectors, 8 one number.
GltfWriter some_accessors() {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    writer.array(std::vector<float>{0, 0, 0, 1, not_a_number, 0, 0, 1, 0}, "VEC3");
    writer.array(std::vector<std::uint16_t>{0, 1, 3}, "SCALAR", GltfWriter::u16);
    writer.array(std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0}, "VEC4", GltfWriter::u8);
    writer.array(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    writer.array(std::vector<float>{0, 1}, "SCALAR");
    writer.array(std::vector<float>{0, 0, 0, 1, 0, 0}, "VEC3");
    writer.array(std::vector<float>(9), "VEC3");
    writer.array(std::vector<float>{1}, "SCALAR");
    return writer;
}

struct Fault {
    std::string what;
    std::string node; ///< node 1; node 0 shows a triangle
    std::string mesh; ///< mesh 1; mesh 0 is that triangle
    std::string more;
    std::size_t triangles; ///< that show all the same
    std::string warning; ///< a part of the only one
};

void PrintTo(Fault const& fault, std::ostream* out) {
    *out << fault.what;
}

class GltfFault : public testing::TestWithParam<Fault> {};

TEST_P(GltfFault, CostsWhatItConcerns) {
    Fault const& fault = GetParam();
    TemporaryFolder const folder;
    std::string const text = some_accessors().json(R"("scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},)" + fault.node +
                                                   R"(,{}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]},)" +
                                                   fault.mesh + "]" + fault.more);
    Scene const scene = import_scene(folder.write("a.gltf", text));
    EXPECT_EQ(shown_triangles(scene), fault.triangles) << lines_of(scene);
    ASSERT_EQ(scene.warnings.size(), 1u) << lines_of(scene);
    EXPECT_NE(scene.warnings[0].find(fault.warning), std::string::npos) << scene.warnings[0];
}

std::string const sound = R"({"primitives":[{"attributes":{"POSITION":0}}]})";
std::string const shows = R"({"mesh":1})";

/// A mesh of one primitive.
std::string mesh_of(std::string const& primitive) {
    return R"({"name":"it","primitives":[{)" + primitive + "}]}";
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, GltfFault,
    testing::Values(
        Fault{"no such accessor", shows, mesh_of(R"("attributes":{"POSITION":88})"), "", 1,
              "mesh 1 'it': accessor 88 is used but does not exist"},
        Fault{"an accessor of text", shows, mesh_of(R"("attributes":{"POSITION":"0"})"), "", 1, "mesh 1 'it': "},
        Fault{"a vertex that is no number", shows, mesh_of(R"("attributes":{"POSITION":1})"), "", 1,
              "mesh 1 'it': the position of vertex 1 is not a number"},
        Fault{"an index beyond the vertices", shows, mesh_of(R"("attributes":{"POSITION":0},"indices":2)"), "", 1,
              "mesh 1 'it': vertex index 3 is out of range"},
        Fault{"indices that are none", shows, mesh_of(R"("attributes":{"POSITION":0},"indices":5)"), "", 1,
              "mesh 1 'it': accessor 5"},
        Fault{"an attribute too short", shows, mesh_of(R"("attributes":{"POSITION":0,"TEXCOORD_0":5})"), "", 1,
              "TEXCOORD_0 has 2 entries for 3 vertices"},
        Fault{"one primitive of two", shows,
              R"({"primitives":[{"attributes":{"POSITION":1}},{"attributes":{"POSITION":0}}]})", "", 2, "mesh 1"},
        Fault{"a primitive without attributes", shows, R"({"primitives":[{},{"attributes":{"POSITION":0}}]})", "", 2,
              "without positions"},
        Fault{"a mesh without primitives", shows, R"({"name":"it"})", "", 1, "mesh 1 'it' has no primitives"},
        Fault{"a mesh that is a number", shows, "7", "", 1, "mesh 1 has no primitives"},
        Fault{"no such material", shows, mesh_of(R"("attributes":{"POSITION":0},"material":3)"), "", 2,
              "mesh 1 'it': material 3 does not exist"},
        Fault{"an unknown mode", shows, mesh_of(R"("attributes":{"POSITION":0},"mode":9)"), "", 1, "mode 9"},
        Fault{"different morph targets", shows,
              R"({"name":"it","primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":7}]},)"
              R"({"attributes":{"POSITION":0}}]})",
              "", 3, "mesh 1 'it': its primitives have different morph targets"}));

INSTANTIATE_TEST_SUITE_P(
    Nodes, GltfFault,
    testing::Values(
        Fault{"no such mesh", R"({"name":"door","mesh":9})", sound, "", 1, "node 1 'door': mesh 9 does not exist"},
        Fault{"no such child", R"({"mesh":1,"children":[55]})", sound, "", 2, "node 1: node 55 does not exist"},
        Fault{"no such camera", R"({"mesh":1,"camera":3})", sound, "", 2, "node 1: camera 3 does not exist"},
        Fault{"no such light", R"({"mesh":1,"extensions":{"KHR_lights_punctual":{"light":4}}})", sound, "", 2,
              "node 1: light 4 does not exist"},
        Fault{"no such skin", R"({"mesh":1,"skin":2})", sound, "", 2, "node 1: skin 2 does not exist"},
        Fault{"a light of an unknown type", R"({"mesh":1,"extensions":{"KHR_lights_punctual":{"light":0}}})", sound,
              R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"neon"}]}})", 2, "unknown type 'neon'"},
        Fault{"a translation of two", R"({"mesh":1,"translation":[1,2]})", sound, "", 2,
              "node 1: its translation is not 3 numbers"},
        Fault{"a rotation with null", R"({"mesh":1,"rotation":[0,0,null,1]})", sound, "", 2,
              "node 1: its rotation is not 4 numbers"},
        Fault{"a matrix of text", R"({"mesh":1,"matrix":"none"})", sound, "", 2,
              "node 1: its matrix is not 16 numbers"},
        Fault{"a scale beyond all", R"({"name":"door","mesh":1,"scale":[1e300,1,1]})", sound, "", 2,
              "node 1 'door' has a transform that is not a number or out of range"},
        Fault{"a node that is text", R"("node")", sound, "", 1, "node 1 is not an object"},
        Fault{"a skin without its node", R"({"mesh":1,"skin":0})",
              mesh_of(R"("attributes":{"POSITION":0,"JOINTS_0":3,"WEIGHTS_0":4})"), R"(,"skins":[{"joints":[7]}])", 2,
              "skin 0: joint node 7 does not exist"},
        Fault{"a joint beyond the skin", R"({"mesh":1,"skin":0})",
              mesh_of(R"("attributes":{"POSITION":0,"JOINTS_0":3,"WEIGHTS_0":4})"), R"(,"skins":[{"joints":[1]}])", 2,
              "uses joint 3 of a skin with 1"},
        Fault{"inverse bind matrices that are none", R"({"mesh":1,"skin":0})",
              mesh_of(R"("attributes":{"POSITION":0,"JOINTS_0":3,"WEIGHTS_0":4})"),
              R"(,"skins":[{"name":"s","joints":[1,1,1,1],"inverseBindMatrices":6}])", 2, "skin 0 's': accessor 6"}));

INSTANTIATE_TEST_SUITE_P(
    Pictures, GltfFault,
    testing::Values(
        Fault{"an image without a place", shows, mesh_of(R"("attributes":{"POSITION":0},"material":0)"),
              R"(,"images":[{"name":"wood"}],"textures":[{"source":0}],"materials":)"
              R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])",
              2, "image 'wood"},
        Fault{"an image in a view that is not there", shows, mesh_of(R"("attributes":{"POSITION":0},"material":0)"),
              R"(,"images":[{"bufferView":77,"mimeType":"image/png"}],"textures":[{"source":0}],"materials":)"
              R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])",
              2, "buffer view 77"},
        Fault{"no such texture", shows, mesh_of(R"("attributes":{"POSITION":0},"material":0)"),
              R"(,"materials":[{"name":"oak","pbrMetallicRoughness":{"baseColorTexture":{"index":5}}}])", 2,
              "material 0 'oak': texture 5 does not exist"},
        Fault{"no such image", shows, mesh_of(R"("attributes":{"POSITION":0},"material":0)"),
              R"(,"textures":[{"source":4}],"materials":[{"normalTexture":{"index":0}}])", 2,
              "texture 0: image 4 does not exist"}));

INSTANTIATE_TEST_SUITE_P(
    Animations, GltfFault,
    testing::Values(
        Fault{"no such sampler", shows, sound,
              R"(,"animations":[{"samplers":[],"channels":[{"sampler":0,"target":{"node":0,"path":"scale"}}]}])", 2,
              "animation 'clip 1': sampler 0 does not exist"},
        Fault{"no such keys", shows, sound,
              R"(,"animations":[{"name":"go","samplers":[{"input":5,"output":66}],"channels":)"
              R"([{"sampler":0,"target":{"node":0,"path":"scale"}}]}])",
              2, "animation 'go': accessor 66"},
        Fault{"values that do not fit", shows, sound,
              R"(,"animations":[{"name":"go","samplers":[{"input":5,"output":7}],"channels":)"
              R"([{"sampler":0,"target":{"node":0,"path":"scale"}}]}])",
              2, "animation 'go': 9 values do not fit 2 keys"},
        Fault{"values that are no numbers", shows, sound,
              R"(,"animations":[{"name":"go","samplers":[{"input":8,"output":1}],"channels":)"
              R"([{"sampler":0,"target":{"node":0,"path":"weights"}}]}])",
              2, "animation 'go'"}));

INSTANTIATE_TEST_SUITE_P(
    Files, GltfFault,
    testing::Values(Fault{"a buffer that is not there", shows, sound,
                          R"(,"images":[{"bufferView":99,"name":"sky","mimeType":"image/jpeg"}])", 2, "buffer view 99"},
                    Fault{"a list that is none", shows, sound, R"(,"cameras":{"a":1},"textures":7,"skins":[null])", 2,
                          "skin 0"},
                    Fault{"an extension that nobody knows", shows, sound, R"(,"extensionsUsed":["FANCY_a",7])", 2,
                          "extension FANCY_a"},
                    Fault{"one that it requires", shows, sound,
                          R"(,"extensionsUsed":["FANCY_b"],"extensionsRequired":["FANCY_b"])", 2, "FANCY_b"}));

TEST(GltfFaults, OneChannelOfTwoPlays) {
    TemporaryFolder const folder;
    Scene const scene = import_scene(folder.write(
        "a.gltf",
        some_accessors().json(one_mesh(
            R"("attributes":{"POSITION":0})",
            R"(,"animations":[{"samplers":[{"input":5,"output":6},{"input":5,"output":7}],"channels":)"
            R"([{"sampler":1,"target":{"node":0,"path":"scale"}},{"sampler":0,"target":{"node":0,"path":"translation"}}]}])"))));
    ASSERT_EQ(scene.clips.size(), 1u);
    ASSERT_EQ(scene.clips[0].channels.size(), 1u);
    EXPECT_EQ(scene.clips[0].channels[0].property, AnimatedProperty::translation);
}

TEST(GltfFaults, AMissingBufferFileCostsWhatIsInIt) {
    TemporaryFolder const folder;
    std::string text = some_accessors().json(
        R"("nodes":[{"mesh":0},{"mesh":1}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]},)"
        R"({"primitives":[{"attributes":{"POSITION":9}}]}])");
    auto const insert_before_end = [&](std::string const& list, std::string const& what) {
        std::size_t const at = text.find(']', text.find("\"" + list + "\":["));
        text.insert(at, what);
    };
    insert_before_end("buffers", R"(,{"byteLength":36,"uri":"gone.bin"})");
    insert_before_end("bufferViews", R"(,{"buffer":1,"byteLength":36})");
    insert_before_end("accessors", R"(,{"bufferView":9,"componentType":5126,"count":3,"type":"VEC3"})");
    Scene const missing = import_scene(folder.write("a.gltf", text));
    EXPECT_EQ(shown_triangles(missing), 1u);
    EXPECT_NE(lines_of(missing).find("gone.bin"), std::string::npos) << lines_of(missing);
    folder.write("gone.bin", "short");
    Scene const is_short = import_scene(folder.path() / "a.gltf");
    EXPECT_EQ(shown_triangles(is_short), 1u);
    EXPECT_NE(lines_of(is_short).find("gone.bin"), std::string::npos) << lines_of(is_short);
    folder.write("gone.bin", std::string(reinterpret_cast<char const*>(triangle_positions.data()), 36));
    Scene const whole = import_scene(folder.path() / "a.gltf");
    EXPECT_EQ(shown_triangles(whole), 2u);
    EXPECT_EQ(lines_of(whole), "");
}

TEST(GltfFaults, WhereNothingIsLeftTheFirstOneIsTheError) {
    TemporaryFolder const folder;
    for (auto const& [primitive, part] :
         {std::pair<std::string, std::string>{R"("attributes":{"POSITION":88})", "accessor 88"},
          {R"("attributes":{"POSITION":1})", "the position of vertex 1 is not a number"}}) {
        try {
            import_scene(folder.write("a.gltf", some_accessors().json(one_mesh(primitive))));
            ADD_FAILURE() << "no error";
        } catch (InputError const& error) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
    }
}

std::string word(std::size_t value) {
    auto const v = static_cast<std::uint32_t>(value);
    return std::string(reinterpret_cast<char const*>(&v), 4);
}

/// A chunk, its length that of the data.
std::string chunk(std::string const& kind, std::string const& data) {
    return word(data.size()) + kind + data;
}

std::string glb_of(std::string const& chunks) {
    return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
}

/// JSON of a triangle whose buffer is in the file, filled up to a multiple of four.
std::string padded_json(bool embed, char filling = ' ') {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    std::string text = writer.json(one_mesh(R"("attributes":{"POSITION":0})"), embed);
    text.resize((text.size() / 4 + 1) * 4, filling);
    return text;
}

std::string const bin_kind("BIN\0", 4);
std::string const triangle_bytes(reinterpret_cast<char const*>(triangle_positions.data()), 36);

/// It shows its triangle, without a word.
void expect_whole(std::string const& what, std::filesystem::path const& file) {
    SCOPED_TRACE(what);
    try {
        Scene const scene = import_scene(file);
        EXPECT_EQ(shown_triangles(scene), 1u);
        EXPECT_EQ(lines_of(scene), "");
    } catch (InputError const& error) {
        ADD_FAILURE() << error.what();
    }
}

TEST(GltfContainer, ValidFilesAreNeverRefused) {
    TemporaryFolder const folder;
    std::string const json = chunk("JSON", padded_json(false));
    std::string const own_data = chunk("JSON", padded_json(true));
    std::string const other = chunk("XTRA", "hello world!");
    std::string const bin = chunk(bin_kind, triangle_bytes);
    for (auto const& [name, bytes] : std::vector<std::pair<std::string, std::string>>{
             {"plain", glb_of(json + bin)},
             {"unknown chunk after BIN", glb_of(json + bin + other)},
             {"unknown chunk before BIN", glb_of(json + other + bin)},
             {"unknown chunks on both sides", glb_of(json + other + other + bin + other)},
             {"unknown chunk alone", glb_of(own_data + other)},
             {"unknown chunk without bytes", glb_of(json + chunk("XTRA", "") + bin)},
             {"no chunk", glb_of(own_data)},
             {"empty BIN", glb_of(own_data + chunk(bin_kind, ""))},
             {"empty BIN and another", glb_of(own_data + chunk(bin_kind, "") + other)},
             {"a BIN that is filled up", glb_of(json + chunk(bin_kind, triangle_bytes + std::string(3, '\0')))},
             {"bytes after the end", glb_of(json + bin) + std::string(64, '\0')},
             {"JSON filled with zeros", glb_of(chunk("JSON", padded_json(false, '\0')) + bin)},
         }) {
        expect_whole(name, folder.write("a.glb", bytes));
    }
    expect_whole("byte order mark", folder.write("a.gltf", "\xef\xbb\xbf" + padded_json(true)));
    expect_whole("binary glTF with the other ending", folder.write("b.gltf", glb_of(json + bin)));
    expect_whole("text with the other ending", folder.write("c.glb", padded_json(true)));
}

TEST(GltfContainer, ValidJsonIsNeverRefused) {
    TemporaryFolder const folder;
    auto const changed = [](std::string const& from, std::string const& to) {
        std::string text = padded_json(true);
        std::size_t const at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    };
    std::string const octets = "data:application/octet-stream;base64";
    for (auto const& [from, to] : std::vector<std::pair<std::string, std::string>>{
             {octets, "data:application/gltf-buffer;base64"},
             {octets, "data:;base64"},
             {octets, "data:application/x-mesh;name=a;base64"},
             {R"("version":"2.0")",
              R"("version":"2.1","minVersion":"2.0","copyright":"\u00a9","extras":[[1],{"a":null}])"},
             {R"("byteLength":36,"uri")", R"("byteLength":36,"name":"b","extras":{"deep":[1,2,{"uri":3}]},"uri")"},
             {"}],\"bufferViews\"", "},{\"byteLength\":500}],\"bufferViews\""}, // nobody uses it
             {R"("scene":0,)", R"("extensions":{"FANCY_a":{"b":[1]}},)"},
             {R"("primitives":[{)", R"("weights":[],"primitives":[{"targets":[],"mode":4,"extensions":{},)"},
         }) {
        expect_whole(to, folder.write("a.gltf", changed(from, to)));
    }
    // Two floats are "AAA" in percent signs: 36 bytes as they are in a data URI without base64.
    std::string bytes;
    for (char const c : triangle_bytes) {
        constexpr char digits[] = "0123456789abcdef";
        auto const value = static_cast<unsigned char>(c);
        bytes += {'%', digits[value >> 4], digits[value & 15]};
    }
    std::string text = padded_json(true);
    std::size_t const first = text.find("data:");
    text.replace(first, text.find('"', first) - first, "data:application/octet-stream," + bytes);
    expect_whole("data URI of percent signs", folder.write("a.gltf", text));
}

TEST(GltfContainer, ExtrasTakeNothingOfTheBudget) {
    TemporaryFolder const folder;
    std::string numbers = "0";
    for (int i = 0; i < 100'000; ++i) {
        numbers += ",1";
    }
    std::string text = padded_json(true);
    text.insert(text.find("\"meshes\""), R"("extras":{"a":[)" + numbers + R"(],"b":{"extras":[]},"c":"d"},)");
    ImportOptions options;
    options.memory_bytes = 2 << 20;
    Scene const scene = import_scene(folder.write("a.gltf", text), {}, options);
    EXPECT_EQ(shown_triangles(scene), 1u);
}

TEST(GltfContainer, ACutFileShowsWhatIsThere) {
    TemporaryFolder const folder;
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    writer.array(triangle_positions, "VEC3");
    std::string const whole =
        writer.glb(R"("nodes":[{"mesh":0},{"mesh":1}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]},)"
                   R"({"primitives":[{"attributes":{"POSITION":1}}]}])");
    std::filesystem::path const cut = folder.write("a.glb", whole.substr(0, whole.size() - 20));
    Scene const scene = import_scene(cut);
    EXPECT_EQ(shown_triangles(scene), 1u);
    EXPECT_NE(lines_of(scene).find("the file is truncated"), std::string::npos) << lines_of(scene);
    ImportOptions serving;
    serving.is_serving = true;
    EXPECT_THROW(import_scene(cut, {}, serving), InputError) << "it may be being written";
}

} // namespace
} // namespace framelet
