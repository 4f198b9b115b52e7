#include "client/video/y4m.h"

#include <array>
#include <cmath>

namespace framelet {
namespace {

constexpr int fraction_bits = 16;

/// Weights of the bytes red, green and blue in Y, Cb and Cr, in units of 2^-fraction_bits.
struct Weights {
    std::array<int, 3> y, cb, cr;
};

int fixed(double value) {
    return static_cast<int>(std::lround(value * (1 << fraction_bits)));
}

/// The weights of limited range: Y takes 219 steps from 16 on, Cb and Cr 224 around 128. `red` and `blue`: their shares
/// of luma.
Weights weights(double red, double blue) {
    double const luma = 219.0 / 255;
    double const from_blue = 112.0 / 255 / (1 - blue);
    double const from_red = 112.0 / 255 / (1 - red);
    // Green takes what is left, so that greys have no colour and white is 235 exactly.
    Weights out{{fixed(luma * red), 0, fixed(luma * blue)},
                {fixed(-from_blue * red), 0, fixed(112.0 / 255)},
                {fixed(112.0 / 255), 0, fixed(-from_red * blue)}};
    out.y[1] = fixed(luma) - out.y[0] - out.y[2];
    out.cb[1] = -out.cb[0] - out.cb[2];
    out.cr[1] = -out.cr[0] - out.cr[2];
    return out;
}

} // namespace

YuvMatrix yuv_matrix(Viewport size) {
    return size.width >= 1280 || size.height > 576 ? YuvMatrix::bt709 : YuvMatrix::bt601;
}

std::string y4m_header(Viewport size, PictureRate rate) {
    return "YUV4MPEG2 W" + std::to_string(size.width) + " H" + std::to_string(size.height) + " F" +
           std::to_string(rate.pictures) + ":" + std::to_string(rate.seconds) + " Ip A1:1 C444 XCOLORRANGE=LIMITED\n";
}

void encode_y4m_picture(Picture const& picture, YuvMatrix matrix, std::string& out) {
    constexpr char line[] = "FRAME\n";
    constexpr std::size_t line_length = sizeof(line) - 1;
    constexpr int half = 1 << (fraction_bits - 1);
    Weights const by = matrix == YuvMatrix::bt709 ? weights(0.2126, 0.0722) : weights(0.299, 0.114);
    std::size_t const pixels = picture.rgba.size() / 4;
    out.resize(line_length + 3 * pixels);
    out.replace(0, line_length, line);
    char* const planes = out.data() + line_length;
    auto const make_plane = [&](std::size_t plane, std::array<int, 3> const& weight, int offset) {
        char* const to = planes + plane * pixels;
        for (std::size_t i = 0; i < pixels; ++i) {
            std::uint8_t const* const from = &picture.rgba[4 * i];
            int const sum =
                weight[0] * from[0] + weight[1] * from[1] + weight[2] * from[2] + (offset << fraction_bits) + half;
            to[i] = static_cast<char>(sum >> fraction_bits);
        }
    };
    make_plane(0, by.y, 16);
    make_plane(1, by.cb, 128);
    make_plane(2, by.cr, 128);
}

} // namespace framelet
