// The program `fuzz_seeds FOLDER`: writes well-formed inputs of every fuzz target, one folder each.
#include <bit>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>

#include "common/files/picture_writer.h"
#include "protocol/codec/batch_codec.h"
#include "protocol/codec/color/plane_codec.h"
#include "protocol/codec/geometry/shape_coding.h"
#include "protocol/codec/geometry/track_codec.h"
#include "protocol/messages/message_codec.h"
#include "tests/fuzz/session_input.h"

namespace {

using namespace framelet;

/// A batch of slopes, an edge, and noise of growing strength; `qp` of the framelets counts up from the first.
Batch make_batch(std::size_t count, std::uint8_t first_qp) {
    std::mt19937 random(static_cast<std::uint32_t>(count));
    Batch batch;
    batch.number = 1;
    batch.view.viewport = {256, 256};
    for (std::size_t i = 0; i < count; ++i) {
        DisplayFramelet& framelet = batch.framelets.emplace_back();
        framelet.tile = make_tile(4, static_cast<std::uint32_t>(i % 16), static_cast<std::uint32_t>(i / 16));
        for (std::uint32_t k = 0; k < framelet_samples; ++k) {
            unsigned const noise = static_cast<unsigned>(random()) % static_cast<unsigned>(8 * i + 1);
            framelet.red[k] = static_cast<std::uint8_t>(8 * morton_x(k) + noise);
            framelet.green[k] = static_cast<std::uint8_t>(morton_x(k) + morton_y(k) > 12 ? 200 : 30);
            framelet.blue[k] = static_cast<std::uint8_t>(100 + noise);
        }
        batch.qp.push_back(static_cast<std::uint8_t>((first_qp + 9 * i) % (coarsest_qp + 1)));
    }
    return batch;
}

/// Adds shapes: an edge between two layers, one of them on a moving body, and an outlier.
void add_shapes(Batch& batch) {
    for (std::size_t i = 0; i < batch.framelets.size(); ++i) {
        FrameletShape& shape = batch.shapes.emplace_back();
        shape.layer_count = 2;
        shape.layers[0] = {0.25f, 0.001f, 0, 0.0001f, static_body, {}};
        shape.layers[1] = {0.5f, 0, 0.002f, 0.0001f, 1, {{Vec3(i % 2 == 0 ? 1 : 0)}, {}, {}, {}, {}}};
        for (std::uint32_t k = 0; k < framelet_samples; ++k) {
            shape.layer_of[k] = morton_x(k) < 1 + i % 15 ? 0 : 1;
        }
        shape.layer_of[i % framelet_samples] = FrameletShape::outlier;
        shape.outliers.push_back({1, 1, {}});
    }
    batch.tracks.push_back({1, 60, {BodyPose{}, BodyPose{{1, 0, 0}, {1, 0, 0, 0}, {1, 1, 1}}}});
}

void write(std::filesystem::path const& file, std::vector<std::uint8_t> const& bytes) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<char const*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

void append(std::vector<std::uint8_t>& out, ByteView bytes) {
    for (std::byte const byte : bytes) {
        out.push_back(std::to_integer<std::uint8_t>(byte));
    }
}

/// Writes a message alone, and as the only one of a connection.
void write_message(std::filesystem::path const& folder, Message const& message, std::string const& name) {
    std::vector<std::uint8_t> body;
    append(body, encode_message(message));
    write(folder / "message" / name, body);
    std::vector<std::uint8_t> stream{1};
    for (int shift = 0; shift < 32; shift += 8) {
        stream.push_back(static_cast<std::uint8_t>(body.size() >> shift));
    }
    stream.insert(stream.end(), body.begin(), body.end());
    write(folder / "stream" / name, stream);
}

/// Number of the encoding as fuzz_batch takes it.
std::uint8_t number_of(SampleEncoding encoding) {
    return static_cast<std::uint8_t>(encoding == SampleEncoding::exact ? 0 : encoding == SampleEncoding::haar ? 1 : 2);
}

void write_batch(std::filesystem::path const& folder, EncodedBatch const& encoded, std::string const& name) {
    std::vector<std::uint8_t> payload{static_cast<std::uint8_t>(encoded.tiles.size()),
                                      static_cast<std::uint8_t>(encoded.tiles.size() >> 8),
                                      number_of(encoded.encoding)};
    append(payload, encoded.payload);
    write(folder / "batch" / name, payload);
    write_message(folder, encoded, "batch_" + name);
}

/// Writes the batch as it moves right, so that the later ones are predicted from the first.
void write_sequence(std::filesystem::path const& folder, Batch batch, std::string const& name) {
    BatchCodec codec;
    BatchMemory memory;
    std::vector<std::uint8_t> bodies;
    for (int i = 0; i < 3; ++i) {
        batch.number = static_cast<std::uint64_t>(i + 1);
        for (DisplayFramelet& framelet : batch.framelets) {
            auto const moved = [](auto& samples) {
                auto const old = samples;
                for (std::uint32_t k = 0; k < framelet_samples; ++k) {
                    samples[k] = old[morton_index((morton_x(k) + 15) % framelet_side, morton_y(k))];
                }
            };
            moved(framelet.red);
            moved(framelet.green);
            moved(framelet.blue);
        }
        EncodedBatch const encoded = codec.encode(batch, &memory);
        write_batch(folder, encoded, name + "_" + std::to_string(i));
        std::vector<std::uint8_t> body;
        append(body, encode_message(encoded));
        bodies.push_back(static_cast<std::uint8_t>(body.size()));
        bodies.push_back(static_cast<std::uint8_t>(body.size() >> 8));
        bodies.insert(bodies.end(), body.begin(), body.end());
    }
    write(folder / "viewer" / name, bodies);
}

/// Writes a picture, and behind it batches without framelets that are not to be shown for long, with long tracks.
void write_waiting(std::filesystem::path const& folder) {
    Batch batch = make_batch(20, 1);
    add_shapes(batch);
    std::vector<std::uint8_t> bodies;
    BatchCodec codec;
    BatchMemory memory;
    for (int i = 0; i < 60; ++i) {
        std::vector<std::uint8_t> body;
        append(body, encode_message(codec.encode(batch, &memory)));
        bodies.push_back(static_cast<std::uint8_t>(body.size()));
        bodies.push_back(static_cast<std::uint8_t>(body.size() >> 8));
        bodies.insert(bodies.end(), body.begin(), body.end());
        ++batch.number;
        batch.shown_from = 1e6;
        batch.framelets.clear();
        batch.qp.clear();
        batch.shapes.clear();
        batch.tracks.clear();
        for (BodyNumber moving = 1; moving <= 32; ++moving) {
            batch.tracks.push_back({moving, 0, std::vector<BodyPose>(max_track_keys)});
        }
    }
    write(folder / "viewer" / "waiting", bodies);
}

void write_planes(std::filesystem::path const& folder, Batch const& batch, ReferencePicture const* held) {
    PlaneCodec codec;
    PlaneModel model;
    std::vector<std::uint8_t> content{static_cast<std::uint8_t>(batch.framelets.size()),
                                      static_cast<std::uint8_t>(held == nullptr ? 0 : 1)};
    std::vector<DisplayFramelet> decoded = batch.framelets;
    auto const frame = codec.encode(batch.framelets, batch.qp, model, held, decoded);
    content.insert(content.end(), frame.begin(), frame.end());
    write(folder / "planes" / ((held == nullptr ? "alone_" : "predicted_") + std::to_string(batch.framelets.size())),
          content);
}

void write_shapes(std::filesystem::path const& folder, std::span<FrameletShape const> shapes) {
    ShapeModel model;
    RangeWriter writer;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        auto const left = static_cast<std::int32_t>(i % 16 * framelet_side);
        model.write(writer, {left, 0, 4}, shapes[i]);
    }
    auto const frame = writer.finish();
    std::vector<std::uint8_t> content{static_cast<std::uint8_t>(shapes.size())};
    content.insert(content.end(), frame.begin(), frame.end());
    write(folder / "shapes" / std::to_string(shapes.size()), content);
}

std::vector<std::uint8_t> bytes_of(std::string const& text) {
    return {text.begin(), text.end()};
}

/// `count` bytes of a number, the least significant first.
std::string number(std::size_t value, std::size_t count = 4) {
    std::string out;
    for (std::size_t i = 0; i < count; ++i) {
        out.push_back(static_cast<char>(value >> (8 * i)));
    }
    return out;
}

/// An STL file with one triangle, in its form of bytes.
std::string stl_bytes() {
    std::string out = std::string(80, ' ') + number(1);
    for (float const value : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) {
        out += number(std::bit_cast<std::uint32_t>(value));
    }
    return out + number(0, 2);
}

void write_files(std::filesystem::path const& folder) {
    write(folder / "camera" / "still",
          bytes_of(R"({"position":[9,4,12],"target":[0,1,0],"up":[0,1,0],"fov_degrees":50})"));
    write(folder / "camera" / "path", bytes_of(R"({"keys":[{"time":0,"position":[9,4,12],"target":[0,1,0]},
        {"time":2,"position":[-6,3,-10],"target":[0,1,0]}]})"));
    write(folder / "camera" / "scene", bytes_of(R"({"scene_camera":0})"));
    std::string const gltf = R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"materials":[{"alphaMode":"MASK"}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
    write(folder / "scene" / "gltf", bytes_of(std::string(1, '\0') + gltf));
    std::string const padded = gltf + std::string((4 - gltf.size() % 4) % 4, ' ');
    write(folder / "scene" / "glb",
          bytes_of("\1glTF" + number(2) + number(20 + padded.size()) + number(padded.size()) + "JSON" + padded));
    write(folder / "scene" / "obj", bytes_of("\2o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl m\nf 1/1/1 "
                                             "2/1/1 3/1/1\nf 1//1 2//1 3//1\n"));
    write(folder / "scene" / "stl", bytes_of("\3" + stl_bytes()));
    write(
        folder / "scene" / "ply",
        bytes_of("\4ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    write(folder / "scene" / "stl_text",
          bytes_of("\3solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                   "endfacet\nendsolid s\n"));
}

/// A segment of a JPEG file.
std::string jpeg_segment(char marker, std::string const& content) {
    return std::string("\xff") + marker + '\0' + static_cast<char>(content.size() + 2) + content;
}

/// A grey JPEG file of one block. Each of its codes is of one bit.
std::string jpeg_bytes() {
    std::string const sides("\0\2\0\2", 4);
    std::string const only_code = '\1' + std::string(15 + 1, '\0'); // of length 1, which stands for 0
    return "\xff\xd8" + jpeg_segment('\xdb', '\0' + std::string(64, '\1')) +
           jpeg_segment('\xc0', '\x8' + sides + std::string("\1\1\x11\0", 4)) + jpeg_segment('\xc4', '\0' + only_code) +
           jpeg_segment('\xc4', '\x10' + only_code) + jpeg_segment('\xda', std::string("\1\1\0\0\x3f\0", 6)) +
           "\x3f\xff\xd9";
}

/// Writes pictures of 2x2 pixels, and the beginning of one that is a texture elsewhere.
void write_pictures(std::filesystem::path const& folder) {
    std::filesystem::create_directories(folder);
    Picture picture(2, 2);
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        picture.rgba[i] = static_cast<std::uint8_t>(i % 4 == 3 ? 255 : 16 * i);
    }
    write_png(folder / "png", picture);
    write_ppm(folder / "ppm", picture);
    write_exr(folder / "exr", picture, {});
    write_exr(folder / "exr_depth", picture, {1, 2, 3, 4});
    std::string const texels = "abcdefghijkl";
    write(folder / "jpeg", bytes_of(jpeg_bytes()));
    write(folder / "webp", bytes_of("RIFF" + number(26) + "WEBPVP8L" + number(13) +
                                    std::string("\x2f\0\0\0\x10\7\x10\x11\x11\x88\x88\xfe\7\0", 14)));
    write(folder / "tga", bytes_of(std::string("\0\0\2", 3) + std::string(9, '\0') + number(2, 2) + number(2, 2) +
                                   number(24, 2) + texels));
    std::string const palette_sides = number(0) + number(2, 2) + number(2, 2);
    write(folder / "tga_palette", bytes_of(std::string("\0\1\1\0\0\4\0\x18", 8) + palette_sides + number(8, 2) +
                                           texels + std::string("\0\1\2\3", 4)));
    write(folder / "tga_packed", bytes_of(std::string("\0\1\x9\0\0\4\0\x18", 8) + palette_sides + number(16, 2) +
                                          texels + std::string("\1\0\0\1\0\x81\2\0", 8)));
    write(folder / "bmp_palette", bytes_of("BM" + number(78) + number(0) + number(70) + number(40) + number(2) +
                                           number(2) + number(1, 2) + number(8, 2) + std::string(16, '\0') + number(4) +
                                           number(4) + texels + "mnop" + std::string("\0\1\0\0\2\3\0\0", 8)));
    write(folder / "bmp", bytes_of("BM" + number(70) + number(0) + number(54) + number(40) + number(2) + number(2) +
                                   number(1, 2) + number(24, 2) + std::string(24, '\0') + texels + "    "));
    write(folder / "hdr", bytes_of("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n" + texels + "mnop"));
    write(folder / "ktx2", bytes_of("\xabKTX 20\xbb\r\n\x1a\n" + std::string(68, '\0')));
}

/// What a viewer says, and what happens before it: bits of session_input.h.
struct Said {
    Said(auto said) : message(std::move(said)) {}
    Said(unsigned before, Message said) : bits(before), message(std::move(said)) {}

    unsigned bits = 0;
    Message message;
};

/// Writes what viewers say, which answers what comes as long as it is in order; between the messages are turns without
/// a word. `server`: what it asks for.
void write_session(std::filesystem::path const& folder, std::string const& name, unsigned server,
                   std::vector<Said> const& said) {
    std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(server)};
    for (auto const& [bits, message] : said) {
        std::vector<std::uint8_t> body;
        append(body, encode_message(message));
        std::size_t const head = body.size() | bits;
        bytes.push_back(static_cast<std::uint8_t>(head));
        bytes.push_back(static_cast<std::uint8_t>(head >> 8));
        bytes.insert(bytes.end(), body.begin(), body.end());
        bytes.insert(bytes.end(), {0, 0, 0, 0});
    }
    write(folder / "session" / name, bytes);
}

CameraUpdate camera_update(std::uint64_t number, Viewport viewport = {64, 48}) {
    Camera seen;
    seen.position.x = 0.1f * static_cast<float>(number);
    return CameraUpdate{{number, seen, viewport}, -1};
}

void write_sessions(std::filesystem::path const& folder) {
    ClockRequest clock;
    clock.set = ClockRequest::time | ClockRequest::playing | ClockRequest::speed;
    clock.state = {0.5, true, -2};
    Hello const hello{protocol_version, {}, coding::all};
    write_session(folder, "looks", 0,
                  {hello, camera_update(1), Ack{1, 1000, 100}, camera_update(2), Ack{2, 20'000, 100}});
    write_session(
        folder, "resizes", 0,
        {hello, camera_update(1), camera_update(2, {33, 17}), Ack{1, 1000, 100}, camera_update(3, {120, 90})});
    write_session(folder, "lets_go", 0,
                  {hello, camera_update(1), Ack{1, 1000, 100}, Evicted{{{1, Tile{1}}, {1, Tile{5}}}}, clock});
    write_session(folder, "wants", 0,
                  {hello, ViewerSettings{1, 0.5f, true}, camera_update(1), ViewerSettings{-1, 0, false}, clock,
                   Ack{1, 0, 0}, Ack{2, 0, 0}, camera_update(2), Failure{"enough"}});
    Hello worker{protocol_version, {}, coding::none};
    worker.work = {1, 2, 3};
    PathAnswer const light{1, 5, std::vector<float>(3 * framelet_samples, 0.5f)}, none{2, 0, {}};
    write_session(folder, "works", 0, {worker, light, none, PathAnswer{3, 0, {-1}}, camera_update(1)});
    write_session(folder, "answers_twice", 0,
                  {worker, light, {session_input::connects, hello}, camera_update(1), light});
}

/// Writes what viewers say who come back: the ticket of a number is that of this welcome.
void write_returns(std::filesystem::path const& folder) {
    using namespace session_input;
    constexpr unsigned anew = is_cut | connects;
    auto const hello = [](std::string const& with, std::uint64_t ticket = 0, std::uint64_t last_batch = 0) {
        return Hello{protocol_version, with, coding::all, {0, ticket}, last_batch};
    };
    Hello const plain = hello(""), other_codings{protocol_version, "", coding::exact_colour, {0, 1}, 1};
    write_session(
        folder, "comes_back", 0,
        {plain, camera_update(1), Ack{1, 1000, 100}, {anew, hello("", 1, 2)}, camera_update(2), Ack{3, 0, 0}});
    write_session(folder, "lacks", 0, {plain, camera_update(1), {anew, hello("", 1)}, camera_update(1), Ack{1, 0, 0}});
    write_session(folder, "half_open", has_control_token,
                  {hello(control_token), camera_update(1), {connects, hello(control_token, 1, 1)}, camera_update(2)});
    write_session(folder, "cut_twice", 0,
                  {plain, camera_update(1), {anew, hello("", 1, 1)}, {anew, hello("", 1, 1)}, camera_update(1)});
    Evicted const many{std::vector<SentTile>(1200, {1, Tile{5}})};
    write_session(folder, "comes_often", 0,
                  {plain, camera_update(1), {anew, hello("", 1, 1)}, many, {is_repeated, camera_update(1)}});
    write_session(folder, "fits_not", 0, {plain, camera_update(1), {anew, other_codings}, camera_update(1)});
    write_session(folder, "guesses", asks_for_token,
                  {hello("a guess"),
                   {connects, Hello{protocol_version + 1, token}},
                   {connects, Ack{}},
                   {connects, hello(token, 7, 7)},
                   camera_update(1)});
    write_session(folder, "are_many", shares_control,
                  {plain,
                   camera_update(1),
                   {connects, plain},
                   camera_update(1),
                   {connects, plain},
                   {anew, plain},
                   {anew, hello("", 1, 1)},
                   camera_update(2)});
    write_session(folder, "take_turns", asks_for_token | has_control_token,
                  {hello(control_token),
                   camera_update(1, {160, 120}),
                   {anew, hello(token)},
                   camera_update(1, {160, 120}),
                   {anew, hello(token)},
                   camera_update(1, {160, 120}),
                   {anew, hello(control_token, 1, 1)},
                   camera_update(2)});
}

void write_secrets(std::filesystem::path const& folder) {
    write(folder / "token" / "token", bytes_of(std::string(1, '\0') + " 0123456789abcdef0123456789abcdef \r\nmore\n"));
    write(folder / "token" / "known", bytes_of("\1a.example:7070 AA:BB\nrender.example:7071 authorities\n"));
    write(folder / "token" / "changed", bytes_of("\1render.example:7070 AA:CC\n"));
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: fuzz_seeds FOLDER\n";
        return 2;
    }
    std::filesystem::path const folder = argv[1];
    for (std::size_t const count : {0u, 1u, 3u, 20u, 140u}) {
        Batch batch = make_batch(count, 1);
        write_batch(folder, BatchCodec().encode(batch), "lossy_" + std::to_string(count));
        if (count < 128) {
            ReferencePicture held;
            held.show(batch.view.viewport);
            held.prepare_search({});
            held.take(batch.framelets);
            write_planes(folder, batch, &held);
            write_planes(folder, batch, nullptr);
            write_sequence(folder, batch, "predicted_" + std::to_string(count));
        }
        batch.qp.clear();
        write_batch(folder, BatchCodec().encode(batch), "exact_" + std::to_string(count));
        add_shapes(batch);
        write_batch(folder, BatchCodec().encode(batch), "shapes_" + std::to_string(count));
        if (count < 128) {
            write_shapes(folder, batch.shapes);
        }
    }
    write_waiting(folder);
    write_files(folder);
    write_pictures(folder / "picture");
    write_sessions(folder);
    write_returns(folder);
    write_secrets(folder);
    int number = 0;
    SceneCameraInfo const camera{"camera", {}};
    for (Message const& message :
         {Message(Hello{protocol_version, "secret"}), Message(Hello{protocol_version, {}, coding::all, {1, 2}, 3}),
          Message(CameraUpdate{}), Message(ViewerSettings{1, 0}), Message(ClockRequest{}), Message(Ack{3, 4, 5}),
          Message(Evicted{{{3, Tile{5}}}}),
          Message(Welcome{1, "s", "n", {}, {}, {camera}, 2, {}, 7, true, {1, 2}, true, 4}), Message(Status{}),
          Message(Failure{"text"})}) {
        write_message(folder, message, std::to_string(number++));
    }
    return 0;
}
