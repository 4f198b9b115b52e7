#include "server/scene/gltf_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <map>

#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include "common/error.h"
#include "server/scene/gltf_accessor.h"

namespace framelet {
namespace {

constexpr std::array<std::string_view, 7> known_extensions{
    "KHR_lights_punctual", "KHR_texture_transform",      "KHR_materials_emissive_strength",
    "KHR_materials_unlit", "KHR_materials_transmission", "KHR_mesh_quantization",
    "EXT_texture_webp"};

/// JSON nested deeper than this is refused: tinygltf goes through some of it recursively.
constexpr int max_json_depth = 64;
/// tinygltf counts in 32 bits.
constexpr std::uintmax_t max_file_bytes = 0xffffffffu;

std::vector<unsigned char> read_bytes(std::filesystem::path const& file) {
    std::error_code code;
    std::uintmax_t const size = std::filesystem::file_size(file, code);
    if (code || !std::filesystem::is_regular_file(file)) {
        throw InputError("file '" + file.string() + "' cannot be read");
    }
    if (size > max_file_bytes) {
        throw InputError("file '" + file.string() + "' is larger than 4 GiB");
    }
    std::vector<unsigned char> bytes(static_cast<std::size_t>(size));
    std::ifstream stream(file, std::ios::binary);
    if (!stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) {
        throw InputError("file '" + file.string() + "' cannot be read");
    }
    return bytes;
}

bool is_binary(std::vector<unsigned char> const& bytes) {
    return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

/// The JSON of a .glb after checking the lengths of its header and chunks, or the whole .gltf.
std::string_view find_json(std::vector<unsigned char> const& bytes) {
    char const* const text = reinterpret_cast<char const*>(bytes.data());
    if (!is_binary(bytes)) {
        return {text, bytes.size()};
    }
    auto const word = [&](std::size_t offset) {
        std::uint32_t value = 0;
        if (offset + 4 > bytes.size()) {
            throw InputError("the file is truncated: its header is incomplete");
        }
        std::memcpy(&value, bytes.data() + offset, 4);
        return value;
    };
    std::uint64_t const length = word(8);
    std::uint64_t const json_end = 20 + std::uint64_t(word(12));
    if (word(4) != 2) {
        throw InputError("it is binary glTF version " + std::to_string(word(4)) + "; only 2 is supported");
    }
    if (length > bytes.size() || json_end > length) {
        throw InputError("the file is truncated: it has " + std::to_string(bytes.size()) + " of " +
                         std::to_string(std::max(length, json_end)) + " bytes");
    }
    if (json_end < length) {
        if (json_end + 8 > length || json_end + 8 + word(static_cast<std::size_t>(json_end)) > length) {
            throw InputError("the file is truncated: its binary chunk reaches beyond the end");
        }
    }
    return {text + 20, static_cast<std::size_t>(json_end - 20)};
}

std::string decode_uri(std::string const& uri) {
    std::string result;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        auto const digit = [](char c) { return std::string_view("0123456789abcdef").find(static_cast<char>(c | 32)); };
        std::size_t const high = i + 2 < uri.size() ? digit(uri[i + 1]) : std::string_view::npos;
        std::size_t const low = i + 2 < uri.size() ? digit(uri[i + 2]) : std::string_view::npos;
        if (uri[i] == '%' && high != std::string_view::npos && low != std::string_view::npos) {
            result += static_cast<char>(high * 16 + low);
            i += 2;
        } else {
            result += uri[i];
        }
    }
    return result;
}

/// What tinygltf's file callbacks need to know.
struct FileAccess {
    std::string folder;
    std::map<std::string, std::size_t> buffer_sizes; ///< of buffer files, by path
};

/// Checks the JSON's nesting and version, and notes how much of each buffer file is wanted: a file may be longer than
/// the buffer it holds, which tinygltf takes for an error.
void inspect_json(std::string_view json, FileAccess& access) {
    auto const keep = [](int depth, nlohmann::json::parse_event_t event, nlohmann::json& parsed) {
        if (depth > max_json_depth) {
            throw InputError("its JSON is nested too deeply");
        }
        return event != nlohmann::json::parse_event_t::key || depth != 1 || parsed == "buffers" || parsed == "asset";
    };
    nlohmann::json document;
    try {
        document = nlohmann::json::parse(json, keep);
    } catch (nlohmann::json::exception const& error) {
        std::string const why = error.what();
        throw InputError("its JSON is broken: " +
                         why.substr(why.find("] ") == std::string::npos ? 0 : why.find("] ") + 2));
    }
    auto const member = [](nlohmann::json const& object, char const* key) {
        return object.is_object() && object.contains(key) ? object[key] : nlohmann::json();
    };
    nlohmann::json const version = member(member(document, "asset"), "version");
    if (!version.is_string() || version.get_ref<std::string const&>().substr(0, 2) != "2.") {
        throw InputError(version.is_string()
                             ? "it is glTF version " + version.get<std::string>() + "; only 2.x is supported"
                             : "it is not glTF: \"asset\": {\"version\"} is missing");
    }
    for (nlohmann::json const& buffer : member(document, "buffers")) {
        nlohmann::json const uri = member(buffer, "uri");
        nlohmann::json const size = member(buffer, "byteLength");
        if (uri.is_string() && size.is_number_unsigned()) {
            std::size_t& wanted = access.buffer_sizes[access.folder + "/" + decode_uri(uri.get<std::string>())];
            wanted = std::max(wanted, size.get<std::size_t>());
        }
    }
}

bool file_exists(std::string const& path, void* user) {
    // tinygltf also looks into the working directory, which has nothing to do with the scene.
    auto const& access = *static_cast<FileAccess const*>(user);
    std::error_code code;
    return path.starts_with(access.folder) && std::filesystem::is_regular_file(path, code);
}

std::string same_path(std::string const& path, void*) {
    return path;
}

bool read_whole_file(std::vector<unsigned char>* out, std::string* error, std::string const& path, void* user) {
    auto const& access = *static_cast<FileAccess const*>(user);
    try {
        *out = read_bytes(path);
    } catch (InputError const& problem) {
        *error += problem.what();
        return false;
    }
    auto const wanted = access.buffer_sizes.find(path);
    if (wanted != access.buffer_sizes.end() && wanted->second < out->size()) {
        out->resize(wanted->second);
    }
    return true;
}

/// Keeps the encoded bytes of images that are not in a buffer view; those in one are found through the view, checked.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, unsigned char const* bytes,
                  int size, void*) {
    if (image->bufferView < 0 && size > 0) {
        image->image.assign(bytes, bytes + size);
    }
    return true;
}

void check_extensions(tinygltf::Model const& model, std::vector<std::string>& warnings) {
    auto const known = [](std::string const& name) {
        return std::find(known_extensions.begin(), known_extensions.end(), name) != known_extensions.end();
    };
    for (std::string const& name : model.extensionsRequired) {
        if (!known(name)) {
            throw InputError("it requires the extension " + name + ", which is not supported");
        }
    }
    for (std::string const& name : model.extensionsUsed) {
        if (!known(name)) {
            warnings.push_back("extension " + name + " is not supported and passed over");
        }
    }
}

} // namespace

std::unique_ptr<tinygltf::Model> read_gltf(std::filesystem::path const& file, std::vector<std::string>& warnings) {
    std::vector<unsigned char> const bytes = read_bytes(file);
    FileAccess access;
    access.folder = std::filesystem::absolute(file).parent_path().string();
    std::string_view const json = find_json(bytes);
    inspect_json(json, access);

    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_encoded, nullptr);
    loader.SetFsCallbacks({file_exists, same_path, read_whole_file, nullptr, &access});
    auto model = std::make_unique<tinygltf::Model>();
    std::string error;
    std::string remarks;
    auto const size = static_cast<unsigned>(bytes.size());
    bool loaded = false;
    try {
        loaded = is_binary(bytes)
                     ? loader.LoadBinaryFromMemory(model.get(), &error, &remarks, bytes.data(), size, access.folder)
                     : loader.LoadASCIIFromString(model.get(), &error, &remarks, json.data(), size, access.folder);
    } catch (std::exception const& problem) {
        error = problem.what();
    }
    if (!loaded) {
        throw InputError(error.empty() ? "it is not valid glTF" : error);
    }
    check_extensions(*model, warnings);
    return model;
}

std::vector<EncodedImage> gltf_images(tinygltf::Model const& model, GltfAccessors const& accessors) {
    std::vector<EncodedImage> images;
    for (std::size_t i = 0; i < model.images.size(); ++i) {
        tinygltf::Image const& image = model.images[i];
        bool const embedded = image.bufferView >= 0;
        std::span<std::byte const> const bytes =
            embedded ? accessors.view(image.bufferView) : std::as_bytes(std::span(image.image));
        std::string name = image.uri.empty() ? image.name : decode_uri(image.uri);
        if (name.empty()) {
            name = std::to_string(i);
        }
        if (image.uri.empty()) { // OpenImageIO chooses the decoder by the name's ending
            name += image.mimeType == "image/jpeg" ? ".jpg" : image.mimeType == "image/webp" ? ".webp" : ".png";
        }
        images.push_back({std::move(name), bytes, {}, nullptr});
    }
    return images;
}

} // namespace framelet
