#include "common/files/exr.h"

#include <bit>
#include <concepts>
#include <cstdint>
#include <string_view>
#include <utility>

#include "common/color.h"
#include "common/error.h"

namespace framelet {
namespace {

/// Little-endian, as the whole file is.
class Bytes {
public:
    explicit Bytes(std::size_t expected) { out_.reserve(expected); }

    template <std::unsigned_integral Number>
    void number(Number value) {
        for (std::size_t i = 0; i < sizeof(Number); ++i) {
            out_.push_back(static_cast<char>(value >> 8 * i & 255u));
        }
    }
    void integer(int value) { number(static_cast<std::uint32_t>(value)); }
    void real(float value) { number(std::bit_cast<std::uint32_t>(value)); }
    void text(std::string_view value) {
        out_.append(value);
        out_.push_back('\0');
    }
    /// What follows are so many bytes of its value.
    void attribute(std::string_view name, std::string_view type, int size) {
        text(name);
        text(type);
        integer(size);
    }
    std::size_t size() const { return out_.size(); }
    std::string take() { return std::move(out_); }

private:
    std::string out_;
};

void add_header(Bytes& out, Picture const& picture, std::string_view channels) {
    constexpr int float_channel = 2;
    constexpr int channel_bytes = 18; // of one with a name of one letter
    out.number(std::uint32_t{20000630}); // what all such files begin with
    out.integer(2); // version, without flags
    out.attribute("channels", "chlist", static_cast<int>(channels.size()) * channel_bytes + 1);
    for (char const name : channels) {
        out.text({&name, 1});
        out.integer(float_channel);
        out.integer(0); // neither to be taken for perceptually linear, nor anything else
        out.integer(1); // a sample a pixel, in both directions
        out.integer(1);
    }
    out.number(std::uint8_t{0});
    out.attribute("compression", "compression", 1);
    out.number(std::uint8_t{0});
    for (char const* const name : {"dataWindow", "displayWindow"}) {
        out.attribute(name, "box2i", 16);
        for (int const value : {0, 0, picture.width - 1, picture.height - 1}) {
            out.integer(value);
        }
    }
    out.attribute("lineOrder", "lineOrder", 1);
    out.number(std::uint8_t{0}); // from the top
    out.attribute("pixelAspectRatio", "float", 4);
    out.real(1);
    out.attribute("screenWindowCenter", "v2f", 8);
    out.real(0);
    out.real(0);
    out.attribute("screenWindowWidth", "float", 4);
    out.real(1);
    out.number(std::uint8_t{0});
}

} // namespace

std::string exr_bytes(Picture const& picture, std::span<float const> depths) {
    std::size_t const width = static_cast<std::size_t>(picture.width);
    std::size_t const height = static_cast<std::size_t>(picture.height);
    FRAMELET_CHECK(depths.empty() || depths.size() == width * height);
    std::string_view const channels = depths.empty() ? "BGR" : "BGRZ"; // by name, as the format wants it
    std::size_t const data_bytes = width * channels.size() * sizeof(float);
    std::size_t const line_bytes = 2 * sizeof(std::uint32_t) + data_bytes;
    constexpr std::size_t most_header_bytes = 512;
    Bytes out(most_header_bytes + height * (sizeof(std::uint64_t) + line_bytes));
    add_header(out, picture, channels);
    std::size_t const first_line = out.size() + height * sizeof(std::uint64_t);
    for (std::size_t y = 0; y < height; ++y) {
        out.number(static_cast<std::uint64_t>(first_line + y * line_bytes));
    }
    for (std::size_t y = 0; y < height; ++y) {
        out.integer(static_cast<int>(y));
        out.integer(static_cast<int>(data_bytes));
        for (std::size_t const channel : {2u, 1u, 0u}) {
            for (std::size_t x = 0; x < width; ++x) {
                out.real(linear_from_srgb_byte(picture.rgba[4 * (y * width + x) + channel]));
            }
        }
        if (!depths.empty()) {
            for (float const depth : depths.subspan(y * width, width)) {
                out.real(depth);
            }
        }
    }
    return out.take();
}

} // namespace framelet
