#include "server/scene/gltf/gltf_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include "server/scene/gltf/gltf_accessor.h"
#include "server/scene/gltf/gltf_compression.h"
#include "server/scene/gltf/gltf_container.h"
#include "server/scene/gltf/gltf_document.h"
#include "server/scene/gltf/gltf_extensions.h"
#include "server/scene/reading/faults.h"
#include "server/scene/reading/file_bytes.h"
#include "server/scene/reading/file_ending.h"
#include "server/scene/reading/named_file.h"

namespace framelet {
namespace {

constexpr std::string_view data_scheme = "data:";

using Bytes = std::vector<std::byte>;

std::string decode_uri(std::string_view uri) {
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

Bytes decode_base64(std::string_view text) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    Bytes bytes;
    bytes.reserve(text.size() / 4 * 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (char const c : text.substr(0, text.find_last_not_of('=') + 1)) {
        std::size_t const value = digits.find(c);
        if (value == std::string_view::npos) {
            throw InputError("its base64 is broken");
        }
        bits = bits << 6 | static_cast<std::uint32_t>(value);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes.push_back(static_cast<std::byte>(bits >> count & 255));
        }
    }
    return bytes;
}

/// The data of a "data:" URI (RFC 2397), whatever media type that says.
Bytes decode_data_uri(std::string const& uri, ImportBudget& budget) {
    std::size_t const comma = uri.find(',');
    if (comma == std::string::npos) {
        throw InputError("its data URI has no data");
    }
    std::string_view const head = std::string_view(uri).substr(0, comma);
    std::string_view const data = std::string_view(uri).substr(comma + 1);
    budget.reserve(data.size(), 1);
    if (head.ends_with(";base64")) {
        return decode_base64(data);
    }
    std::string const plain = decode_uri(data);
    auto const* const first = reinterpret_cast<std::byte const*>(plain.data());
    return {first, first + plain.size()};
}

/// Reads what the buffers of a file say that they are made of.
class BufferReader {
public:
    BufferReader(SceneFolder const& folder, ImportBudget& budget, std::vector<std::string>& remarks,
                 std::function<void(std::size_t)> on_bytes)
        : folder_(folder), budget_(budget), remarks_(remarks), on_bytes_(std::move(on_bytes)) {}

    Bytes read(std::string const& uri) const {
        if (uri.starts_with(data_scheme)) {
            return decode_data_uri(uri, budget_);
        }
        std::string const name = decode_uri(uri);
        NamedFile const found = find_named_file(folder_, "buffer", name);
        std::optional<RegularFile> const opened = folder_.open(found.file);
        if (!opened) {
            throw InputError(no_named_file(folder_, "buffer", name));
        }
        if (!found.remark.empty()) {
            remarks_.push_back(found.remark);
        }
        return read_file(*opened, found.file.string(), budget_, on_bytes_);
    }

private:
    SceneFolder const& folder_;
    ImportBudget& budget_;
    std::vector<std::string>& remarks_;
    std::function<void(std::size_t)> on_bytes_;
};

/// Finds what each buffer is made of. `data`: the binary chunk, which is the first buffer where that has no URI.
void read_buffers(GltfFile& file, std::optional<std::span<std::byte const>> data, BufferReader const& reader,
                  std::vector<std::string>& faults) {
    Json::array_t const& buffers = list(file.json, "buffers");
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        Faults const of_buffer(named("buffer", i, ""), faults);
        std::span<std::byte const>& bytes = file.buffers.emplace_back();
        std::string const uri = text(buffers[i], "uri");
        of_buffer.tried(
            [&] {
                std::uint64_t const wanted = size(buffers[i], "byteLength", 0);
                if (!uri.empty()) {
                    bytes = file.memory.emplace_back(reader.read(uri));
                } else if (i == 0 && data) {
                    bytes = *data;
                } else {
                    return; // it is wrong only to use it (glTF 2.0 section 3.6.1.1)
                }
                if (bytes.size() < wanted) {
                    file.is_truncated = true;
                    of_buffer.note((uri.empty() || uri.starts_with(data_scheme) ? "it" : "'" + uri + "'") + " has " +
                                   std::to_string(bytes.size()) + " of " + std::to_string(wanted) + " bytes");
                } else if (wanted > 0) {
                    bytes = bytes.first(static_cast<std::size_t>(wanted)); // a file may be longer
                }
            },
            "");
    }
}

/// Bytes that the buffer files of a scene say that they have.
std::uint64_t bytes_beside(Json const& json) {
    std::uint64_t bytes = 0;
    for (Json const& buffer : list(json, "buffers")) {
        std::string const uri = text(buffer, "uri");
        bool const is_file = !uri.empty() && !uri.starts_with(data_scheme);
        bytes += is_file ? static_cast<std::uint64_t>(std::max(0.0, number(buffer, "byteLength", 0))) : 0;
    }
    return bytes;
}

} // namespace

std::unique_ptr<GltfFile> read_gltf(std::filesystem::path const& file, SceneFolder const& folder, ImportBudget& budget,
                                    std::vector<std::string>& remarks, std::vector<std::string>& faults,
                                    Progress const& progress) {
    // What else is large lies beside a .gltf.
    double const file_read = lower_extension(file) == ".glb" ? 0.9 : 0.3;
    RegularFile const opened(file);
    if (!opened) {
        throw InputError("it cannot be read: " + opened.problem());
    }
    auto expected = static_cast<double>(opened.bytes());
    double read = 0, from = 0, to = file_read;
    auto const on_bytes = [&](std::size_t more) {
        read += static_cast<double>(more);
        progress("reading", from + (to - from) * std::min(1.0, read / std::max(1.0, expected)));
    };
    auto out = std::make_unique<GltfFile>();
    std::span<std::byte const> const bytes =
        out->memory.emplace_back(read_file(opened, file.string(), budget, on_bytes));
    GltfContainer const container = open_gltf_container(bytes);
    out->json = parse_gltf_json(container.json, budget);
    out->is_truncated = container.is_cut;
    if (container.is_cut) {
        faults.emplace_back("the file is truncated: it ends before what is in it does");
    }
    out->lacks = note_extensions(out->json, remarks);
    expected = static_cast<double>(bytes_beside(out->json));
    read = 0;
    from = std::exchange(to, 1);
    read_buffers(*out, container.data, BufferReader(folder, budget, remarks, on_bytes), faults);
    decompress_views(*out, budget, faults);
    return out;
}

std::vector<EncodedImage> gltf_images(GltfFile& file, GltfAccessors const& accessors, SceneFolder const& folder,
                                      ImportBudget& budget, std::vector<std::string>& remarks) {
    std::vector<EncodedImage> out;
    Json::array_t const& images = list(file.json, "images");
    for (std::size_t i = 0; i < images.size(); ++i) {
        std::string const uri = text(images[i], "uri");
        bool const in_file = uri.empty() || uri.starts_with(data_scheme);
        EncodedImage image;
        image.name = in_file ? text(images[i], "name") : decode_uri(uri);
        if (image.name.empty()) {
            image.name = std::to_string(i);
        }
        std::string const what = "image '" + image.name + "'";
        try {
            if (!in_file) {
                NamedFile found = find_named_file(folder, "image", image.name);
                if (found.file.empty()) {
                    image.problem = no_named_file(folder, "image", image.name);
                }
                if (!found.remark.empty()) {
                    remarks.push_back(std::move(found.remark));
                }
                image.file = std::move(found.file);
            } else if (!uri.empty()) {
                image.bytes = file.memory.emplace_back(decode_data_uri(uri, budget));
            } else if (index(images[i], "bufferView") != none) {
                image.bytes = accessors.view(index(images[i], "bufferView"));
            }
        } catch (SceneTooLarge const&) {
            throw;
        } catch (InputError const& error) {
            image.problem = what + ": " + error.what();
        }
        out.push_back(std::move(image));
    }
    return out;
}

} // namespace framelet
