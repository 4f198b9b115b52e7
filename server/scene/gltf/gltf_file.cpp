#include "server/scene/gltf/gltf_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include "common/error.h"
#include "server/scene/gltf/gltf_accessor.h"
#include "server/scene/reading/file_ending.h"
#include "server/scene/reading/held_exception.h"
#include "server/scene/reading/named_file.h"

namespace framelet {
namespace {

constexpr std::array<std::string_view, 7> known_extensions{
    "KHR_lights_punctual", "KHR_texture_transform",      "KHR_materials_emissive_strength",
    "KHR_materials_unlit", "KHR_materials_transmission", "KHR_mesh_quantization",
    "EXT_texture_webp"};

bool is_known_extension(std::string_view name) {
    return std::find(known_extensions.begin(), known_extensions.end(), name) != known_extensions.end();
}

/// JSON nested deeper than this is refused: tinygltf goes through some of it recursively.
constexpr int max_json_depth = 64;
constexpr std::size_t longest_media_type = 40;
/// Bytes of the largest file that is read: tinygltf counts in 32 bits.
constexpr std::uintmax_t max_file_bytes = 0xffffffffu;

/// `on_bytes` is called with the number of bytes that have been read since the last call.
std::vector<unsigned char> read_bytes(RegularFile const& file, std::string const& name,
                                      std::function<void(std::size_t)> const& on_bytes) {
    if (file.bytes() > max_file_bytes) {
        throw InputError("file '" + name + "' is larger than 4 GiB");
    }
    std::vector<unsigned char> bytes(static_cast<std::size_t>(file.bytes()));
    constexpr std::size_t part = 8 << 20;
    for (std::size_t at = 0; at < bytes.size(); at += part) {
        std::size_t const count = std::min(part, bytes.size() - at);
        if (!file.read(bytes.data() + at, count)) {
            throw InputError("file '" + name + "' cannot be read");
        }
        on_bytes(count);
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

/// The data that tinygltf's file callbacks need.
struct FileAccess {
    SceneFolder const& folder;
    ImportBudget& budget;
    std::vector<std::string>& warnings;
    Progress const& progress;
    std::uint64_t bytes; ///< to be read: of the scene file, then of its buffers
    std::uint64_t bytes_read = 0;
    double first_fraction = 0; ///< of reading as a whole, at the first of these bytes
    double last_fraction; ///< at the last
    HeldException held = {}; ///< from what tinygltf has called
    std::map<std::string, std::size_t> buffer_sizes = {}; ///< of buffer files, by path
    std::map<std::string, std::filesystem::path> found = {}; ///< the files that paths stand for; empty: none

    std::string path_of(std::string const& uri) const { return folder.path().string() + "/" + decode_uri(uri); }

    bool is_buffer(std::string const& path) const { return buffer_sizes.contains(path); }

    /// The file for a path that tinygltf has made of the folder and a name.
    std::filesystem::path const& find(std::string const& path) {
        auto const [at, is_new] = found.try_emplace(path);
        if (is_new) {
            std::string const name = path.substr(folder.path().string().size() + 1);
            NamedFile file = find_named_file(folder, is_buffer(path) ? "buffer" : "image", name);
            at->second = std::move(file.file);
            if (!file.remark.empty()) {
                warnings.push_back(std::move(file.remark));
            }
        }
        return at->second;
    }

    /// From now on it is buffers that are read, up to this fraction of reading as a whole.
    void expect_buffers(double fraction) {
        bytes = bytes_read = 0;
        for (auto const& [file, wanted] : buffer_sizes) {
            bytes += wanted;
        }
        first_fraction = std::exchange(last_fraction, fraction);
    }
    void report_read(std::size_t more) {
        bytes_read += more;
        double const share = std::min(1.0, static_cast<double>(bytes_read) / std::max(1.0, static_cast<double>(bytes)));
        progress("reading", first_fraction + (last_fraction - first_fraction) * share);
    }
};

using Json = nlohmann::json;

/// The member, or null where there is none.
Json const& member(Json const& object, char const* key) {
    static Json const nothing;
    return object.is_object() && object.contains(key) ? object[key] : nothing;
}

void check_required_extensions(Json const& names) {
    for (Json const& name : names) {
        if (name.is_string() && !is_known_extension(name.get_ref<std::string const&>())) {
            throw InputError("it requires the extension " + name.get<std::string>() + ", which is not supported");
        }
    }
}

/// Throws InputError where an accessor has no buffer view but needs one: tinygltf does not say which accessor it is.
void check_buffer_views(Json const& accessors, Json const& meshes) {
    for (std::size_t i = 0; accessors.is_array() && i < accessors.size(); ++i) {
        Json const& sparse = member(accessors[i], "sparse");
        for (char const* part : {"indices", "values"}) {
            if (sparse.is_object() && !member(member(sparse, part), "bufferView").is_number_integer()) {
                throw InputError("accessor " + std::to_string(i) + " is sparse, but its " + part +
                                 " have no buffer view");
            }
        }
    }
    for (Json const& mesh : meshes) {
        for (Json const& primitive : member(mesh, "primitives")) {
            Json const& indices = member(primitive, "indices");
            if (indices.is_number_unsigned() && accessors.is_array() && indices.get<std::size_t>() < accessors.size() &&
                !member(accessors[indices.get<std::size_t>()], "bufferView").is_number_integer()) {
                throw InputError("accessor " + indices.dump() + " holds vertex indices, but has no buffer view");
            }
        }
    }
}

/// Bytes that are reserved for an object and for a value of the JSON: what tinygltf makes of a material that is "{}",
/// the largest, and of a number in a list of `extras`, with what is parsed before that.
constexpr std::uint64_t object_bytes = sizeof(tinygltf::Material);
constexpr std::uint64_t value_bytes = sizeof(tinygltf::Value) + 3 * sizeof(nlohmann::json);

/// Checks what tinygltf does not, or says less well: the JSON's nesting, its version, extensions and buffer views.
/// Reserves memory for what will be made of it, and notes how much of each buffer file is wanted: a file may be longer
/// than the buffer it holds, which tinygltf takes for an error.
void inspect_json(std::string_view json, FileAccess& access) {
    constexpr std::array<std::string_view, 5> kept{"buffers", "asset", "extensionsRequired", "accessors", "meshes"};
    auto const keep = [&](int depth, Json::parse_event_t event, Json& parsed) {
        if (depth > max_json_depth) {
            throw InputError("its JSON is nested too deeply");
        }
        access.budget.reserve(event == Json::parse_event_t::object_start ? object_bytes
                              : event == Json::parse_event_t::value      ? value_bytes
                                                                         : 0,
                              1);
        return event != Json::parse_event_t::key || depth != 1 ||
               std::find(kept.begin(), kept.end(), parsed.get_ref<std::string const&>()) != kept.end();
    };
    Json document;
    try {
        document = Json::parse(json, keep);
    } catch (Json::exception const& error) {
        std::string const why = error.what();
        throw InputError("its JSON is broken: " +
                         why.substr(why.find("] ") == std::string::npos ? 0 : why.find("] ") + 2));
    }
    Json const& version = member(member(document, "asset"), "version");
    if (!version.is_string() || version.get_ref<std::string const&>().substr(0, 2) != "2.") {
        throw InputError(version.is_string()
                             ? "it is glTF version " + version.get<std::string>() + "; only 2.x is supported"
                             : "it is not glTF: \"asset\": {\"version\"} is missing");
    }
    check_required_extensions(member(document, "extensionsRequired"));
    check_buffer_views(member(document, "accessors"), member(document, "meshes"));
    for (Json const& buffer : member(document, "buffers")) {
        Json const& uri = member(buffer, "uri");
        Json const& size = member(buffer, "byteLength");
        if (uri.is_string() && size.is_number_unsigned()) {
            std::size_t& wanted = access.buffer_sizes[access.path_of(uri.get<std::string>())];
            wanted = std::max(wanted, size.get<std::size_t>());
        }
    }
}

bool file_exists(std::string const& path, void* user) {
    // tinygltf also looks into the working directory, which has nothing to do with the scene.
    auto& access = *static_cast<FileAccess*>(user);
    std::string const folder = access.folder.path().string() + "/";
    if (!path.starts_with(folder)) {
        return false;
    }
    bool const is_found = !access.find(path).empty();
    if (!is_found && access.is_buffer(path) && !access.folder.permits(path)) {
        throw InputError(SceneFolder::refusal("buffer", path.substr(folder.size())));
    }
    return is_found; // of an image that is not `gltf_images` says so
}

std::string same_path(std::string const& path, void*) {
    return path;
}

bool read_whole_file(std::vector<unsigned char>* out, std::string* error, std::string const& path, void* user) {
    auto& access = *static_cast<FileAccess*>(user);
    std::filesystem::path const& found = access.find(path);
    std::optional<RegularFile> const file = access.folder.open(found);
    if (!file) {
        *error += "file '" + path + "' cannot be read";
        return false;
    }
    access.budget.reserve(file->bytes(), 1); // one file may be named a thousand times
    try {
        *out = read_bytes(*file, found.string(), [&](std::size_t count) {
            if (!access.held.call([&] { access.report_read(count); })) {
                throw InputError("it is not wanted any more"); // what is held says why
            }
        });
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

void note_unknown_extensions(tinygltf::Model const& model, std::vector<std::string>& warnings) {
    for (std::string const& name : model.extensionsUsed) {
        if (!is_known_extension(name)) {
            warnings.push_back("extension " + name + " is not supported and passed over");
        }
    }
}

} // namespace

std::unique_ptr<tinygltf::Model> read_gltf(std::filesystem::path const& file, SceneFolder const& folder,
                                           ImportBudget& budget, std::vector<std::string>& warnings,
                                           Progress const& progress) {
    constexpr double all_read = 0.9; // then tinygltf takes a while
    double const file_read = lower_extension(file) == ".glb" ? all_read : 0.3; // what else is large lies beside a .gltf
    RegularFile const opened(file);
    if (!opened) {
        throw InputError("it cannot be read: " + opened.problem());
    }
    FileAccess access{folder, budget, warnings, progress, opened.bytes(), 0, 0, file_read};
    budget.reserve(access.bytes, 1);
    std::vector<unsigned char> const bytes =
        read_bytes(opened, file.string(), [&access](std::size_t count) { access.report_read(count); });
    std::string const base = folder.path().string();
    std::string_view const json = find_json(bytes);
    inspect_json(json, access);
    access.expect_buffers(all_read);

    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_encoded, nullptr);
    loader.SetFsCallbacks({file_exists, same_path, read_whole_file, nullptr, &access});
    auto model = std::make_unique<tinygltf::Model>();
    std::string error;
    std::string remarks;
    auto const size = static_cast<unsigned>(bytes.size());
    bool loaded = false;
    try {
        loaded = is_binary(bytes) ? loader.LoadBinaryFromMemory(model.get(), &error, &remarks, bytes.data(), size, base)
                                  : loader.LoadASCIIFromString(model.get(), &error, &remarks, json.data(), size, base);
    } catch (std::bad_alloc const&) {
        throw; // which says nothing of the file
    } catch (std::exception const& problem) {
        error = problem.what();
    }
    access.held.rethrow();
    if (!loaded) {
        throw InputError(error.empty() ? "it is not valid glTF" : error);
    }
    note_unknown_extensions(*model, warnings);
    return model;
}

std::vector<EncodedImage> gltf_images(tinygltf::Model const& model, GltfAccessors const& accessors,
                                      SceneFolder const& folder) {
    std::vector<EncodedImage> images;
    for (std::size_t i = 0; i < model.images.size(); ++i) {
        tinygltf::Image const& image = model.images[i];
        bool const embedded = image.bufferView >= 0;
        std::span<std::byte const> const bytes =
            embedded ? accessors.view(image.bufferView) : std::as_bytes(std::span(image.image));
        bool const in_file = image.uri.empty() || image.uri.starts_with("data:");
        std::string name = in_file ? image.name : decode_uri(image.uri);
        if (name.empty()) {
            name = std::to_string(i);
        }
        if (image.uri.empty()) { // OpenImageIO chooses the decoder by the name's ending
            name += image.mimeType == "image/jpeg" ? ".jpg" : image.mimeType == "image/webp" ? ".webp" : ".png";
        }
        std::string problem;
        if (!in_file && bytes.empty()) {
            problem = no_named_file(folder, "image", name);
        } else if (image.uri.starts_with("data:") && bytes.empty()) {
            problem = "image '" + name + "' holds data of a kind that is not supported: " +
                      image.uri.substr(0, std::min(image.uri.find_first_of(";,"), longest_media_type));
        }
        images.push_back({std::move(name), bytes, {}, nullptr, std::move(problem)});
    }
    return images;
}

} // namespace framelet
