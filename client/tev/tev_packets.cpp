#include "client/tev/tev_packets.h"

#include <bit>
#include <concepts>
#include <cstdint>
#include <utility>

#include "common/color.h"

namespace framelet {
namespace {

constexpr std::uint8_t create_image = 4;
constexpr std::uint8_t update_image_with_strides = 6; // tev calls it UpdateImageV3
constexpr int channels = 3;

template <std::unsigned_integral Number>
void add(std::string& out, Number value) {
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
        out.push_back(static_cast<char>(value >> 8 * i & 255u));
    }
}

void add_integer(std::string& out, int value) {
    add(out, static_cast<std::uint32_t>(value));
}

std::string begun_packet(std::uint8_t kind, bool grabs_focus, std::string const& name) {
    std::string out;
    add_integer(out, 0); // its length, which is not known yet
    add(out, kind);
    add(out, static_cast<std::uint8_t>(grabs_focus ? 1 : 0));
    return out + name + '\0';
}

void add_channel_names(std::string& out) {
    for (char const name : {'R', 'G', 'B'}) {
        out += name;
        out += '\0';
    }
}

std::string finished(std::string packet) {
    std::string length;
    add(length, static_cast<std::uint32_t>(packet.size()));
    return packet.replace(0, length.size(), length);
}

} // namespace

std::string tev_create_image(std::string const& name, Viewport size) {
    std::string out = begun_packet(create_image, true, name);
    for (int const value : {size.width, size.height, channels}) {
        add_integer(out, value);
    }
    add_channel_names(out);
    return finished(std::move(out));
}

std::string tev_update_image(std::string const& name, Picture const& picture) {
    std::string out = begun_packet(update_image_with_strides, false, name);
    add_integer(out, channels);
    add_channel_names(out);
    for (int const value : {0, 0, picture.width, picture.height}) {
        add_integer(out, value);
    }
    for (std::uint64_t const offset : {0, 1, 2}) {
        add(out, offset);
    }
    for (int channel = 0; channel < channels; ++channel) {
        add(out, std::uint64_t{channels}); // from a pixel's value to the next one's
    }
    out.reserve(out.size() + picture.rgba.size() / 4 * channels * sizeof(float));
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        if (i % 4 < channels) {
            add(out, std::bit_cast<std::uint32_t>(linear_from_srgb_byte(picture.rgba[i])));
        }
    }
    return finished(std::move(out));
}

} // namespace framelet
