// Writes small glTF files for tests: data goes into one buffer, each array with a buffer view and an accessor.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <unistd.h>

namespace framelet {

/// A folder that is gone when the test is over.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "framelet-scene-XXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(TemporaryFolder const&) = delete;
    TemporaryFolder& operator=(TemporaryFolder const&) = delete;

    std::filesystem::path write(std::string const& name, std::string const& content) const {
        std::ofstream(path_ / name, std::ios::binary) << content;
        return path_ / name;
    }
    std::filesystem::path const& path() const { return path_; }

private:
    std::filesystem::path path_;
};

class GltfWriter {
public:
    static constexpr int i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126;

    /// Appends raw values as a buffer view and returns its index.
    template <class T>
    int view(std::vector<T> const& values, int stride = 0) {
        data_.resize((data_.size() + 3) / 4 * 4);
        std::string text = R"({"buffer":0,"byteOffset":)" + std::to_string(data_.size()) + R"(,"byteLength":)" +
                           std::to_string(values.size() * sizeof(T));
        text += stride ? R"(,"byteStride":)" + std::to_string(stride) + "}" : "}";
        data_.append(reinterpret_cast<char const*>(values.data()), values.size() * sizeof(T));
        views_.push_back(text);
        return static_cast<int>(views_.size()) - 1;
    }

    int accessor(std::string const& text) {
        accessors_.push_back("{" + text + "}");
        return static_cast<int>(accessors_.size()) - 1;
    }

    /// An accessor over the whole of a new view. `extra` is more JSON, starting with a comma.
    template <class T>
    int array(std::vector<T> const& values, std::string const& type, int component = f32,
              std::string const& extra = {}) {
        std::size_t const width = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<std::size_t>(type[3] - '0');
        int const index = view(values);
        return accessor(R"("bufferView":)" + std::to_string(index) + R"(,"componentType":)" +
                        std::to_string(component) + R"(,"count":)" + std::to_string(values.size() / width) +
                        R"(,"type":")" + type + "\"" + extra);
    }

    std::string json(std::string const& rest, bool embed = true) const {
        auto const list = [](std::vector<std::string> const& items) {
            std::string text = "[";
            for (std::string const& item : items) {
                text += (text.size() > 1 ? "," : "") + item;
            }
            return text + "]";
        };
        return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":)" + std::to_string(data_.size()) +
               (embed ? R"(,"uri":"data:application/octet-stream;base64,)" + base64() + "\"" : "") +
               R"(}],"bufferViews":)" + list(views_) + R"(,"accessors":)" + list(accessors_) + "," + rest + "}";
    }

    std::string glb(std::string const& rest) const {
        std::string text = json(rest, false);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string bin = data_;
        bin.resize((bin.size() + 3) / 4 * 4);
        auto const word = [](std::size_t value) {
            auto const v = static_cast<std::uint32_t>(value);
            return std::string(reinterpret_cast<char const*>(&v), 4);
        };
        return "glTF" + word(2) + word(28 + text.size() + bin.size()) + word(text.size()) + "JSON" + text +
               word(bin.size()) + std::string("BIN\0", 4) + bin;
    }

private:
    std::string base64() const {
        constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string text;
        for (std::size_t i = 0; i < data_.size(); i += 3) {
            std::uint32_t bits = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                bits = bits << 8 | (i + k < data_.size() ? static_cast<unsigned char>(data_[i + k]) : 0u);
            }
            for (std::size_t k = 0; k < 4; ++k) {
                text += i + k <= data_.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
            }
        }
        return text;
    }

    std::string data_;
    std::vector<std::string> views_;
    std::vector<std::string> accessors_;
};

/// The rest of a file with one node that has a mesh of one primitive.
inline std::string one_mesh(std::string const& primitive, std::string const& more = {}) {
    return R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{)" + primitive +
           "}]}]" + more;
}

inline std::vector<float> const triangle_positions{0, 0, 0, 1, 0, 0, 0, 1, 0};

} // namespace framelet
