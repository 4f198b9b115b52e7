#include "tests/evaluation/charts/side_by_side.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include "common/color.h"
#include "common/error.h"

namespace framelet::bench {
namespace {

using Rgb = std::array<std::uint8_t, 3>;
using Palette = std::array<Rgb, 256>;

constexpr char const* font = "DejaVuSans";
constexpr Rgb black{0, 0, 0};

Palette inferno() {
    std::array<float, 256> ramp;
    for (std::size_t i = 0; i < ramp.size(); ++i) {
        ramp[i] = static_cast<float>(i) / 255.0f;
    }
    OIIO::ImageBuf const grey(OIIO::ImageSpec(256, 1, 1, OIIO::TypeDesc::FLOAT), ramp.data());
    OIIO::ImageBuf const colored = OIIO::ImageBufAlgo::color_map(grey, 0, "inferno");
    std::array<std::array<float, 3>, 256> linear;
    FRAMELET_CHECK(colored.get_pixels(OIIO::ROI(0, 256, 0, 1, 0, 1, 0, 3), OIIO::TypeDesc::FLOAT, linear.data()));
    Palette palette;
    for (std::size_t i = 0; i < palette.size(); ++i) {
        std::transform(linear[i].begin(), linear[i].end(), palette[i].begin(), srgb_byte_from_linear);
    }
    return palette;
}

void put(Picture& canvas, int x, int y, Rgb const& color) {
    std::copy_n(color.data(), 3, canvas.row(y) + static_cast<std::size_t>(x) * 4);
}

void paste(Picture& canvas, int left, int top, Picture const& picture) {
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            std::uint8_t const* const from = picture.row(y) + static_cast<std::size_t>(x) * 4;
            put(canvas, left + x, top + y, {from[0], from[1], from[2]});
        }
    }
}

Picture error_picture(Picture const& reference, Picture const& shown, Palette const& palette) {
    Picture out(reference.width, reference.height);
    for (std::size_t i = 0; i < out.rgba.size(); i += 4) {
        double squares = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            double const difference = static_cast<double>(shown.rgba[i + c]) - reference.rgba[i + c];
            squares += difference * difference;
        }
        auto const level = std::lround(std::min(255.0, error_gain * std::sqrt(squares / 3)));
        std::copy_n(palette[static_cast<std::size_t>(level)].data(), 3, &out.rgba[i]);
        out.rgba[i + 3] = 255;
    }
    return out;
}

/// Labels are drawn one at a time, each on a small image of its own.
class Lettering {
public:
    explicit Lettering(int size) : size_(size) {}

    int line_height() const { return size_ + size_ / 2; }

    int width_of(std::string const& text) const {
        OIIO::ROI const box = OIIO::ImageBufAlgo::text_size(text, size_, font);
        return box.xbegin < box.xend ? box.width() : 0; // the other way round where no letter has ink
    }

    /// From `left`, in a line that begins at `top`.
    void draw(Picture& canvas, int left, int top, std::string const& text) const {
        if (text.empty()) {
            return;
        }
        OIIO::ImageSpec const spec(std::min(canvas.width - left, width_of(text) + size_), line_height(), 3,
                                   OIIO::TypeDesc::UINT8);
        OIIO::ImageBuf line(spec);
        OIIO::ImageBufAlgo::fill(line, {1.0f, 1.0f, 1.0f});
        constexpr std::array<float, 3> ink{0.1f, 0.1f, 0.1f};
        if (!OIIO::ImageBufAlgo::render_text(line, 0, size_ + size_ / 8, text, size_, font, ink)) {
            throw InputError("cannot draw the label '" + text + "': " + line.geterror());
        }
        std::vector<Rgb> pixels(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));
        FRAMELET_CHECK(line.get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::UINT8, pixels.data()));
        for (int y = 0; y < spec.height; ++y) {
            for (int x = 0; x < spec.width; ++x) {
                put(canvas, left + x, top + y,
                    pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(spec.width) +
                           static_cast<std::size_t>(x)]);
            }
        }
    }

private:
    int size_;
};

std::string scale_label() {
    return "error, 0 to " + std::to_string((255 + error_gain / 2) / error_gain) + " of 255";
}

/// A bar of all the colours and what they mean.
void draw_scale(Picture& canvas, int left, int top, int width, Lettering const& lettering, Palette const& palette) {
    lettering.draw(canvas, left, top, scale_label());
    int const bar_top = top + lettering.line_height();
    int const bar_bottom = std::min(bar_top + lettering.line_height(), canvas.height);
    for (int y = bar_top; y < bar_bottom; ++y) {
        for (int x = 0; x < width; ++x) {
            bool const frame = y == bar_top || y == bar_bottom - 1 || x == 0 || x == width - 1;
            put(canvas, left + x, y,
                frame ? black : palette[static_cast<std::size_t>(x * 255 / std::max(width - 1, 1))]);
        }
    }
}

} // namespace

Picture side_by_side(Picture const& reference, std::span<Labelled const> shown) {
    if (reference.rgba.empty()) {
        throw InputError("the reference picture is empty");
    }
    for (Labelled const& one : shown) {
        if (one.picture.width != reference.width || one.picture.height != reference.height) {
            throw InputError("picture '" + one.label + "' is not of the reference's size");
        }
    }
    // The whole is shrunk to fit a page when it is wide, so letters grow with the pictures.
    Lettering const lettering(std::clamp(reference.width / 20, 13, 40));
    int const gap = std::clamp(reference.width / 40, 6, 24);
    int column = std::max(reference.width, lettering.width_of(scale_label()));
    for (Labelled const& one : shown) {
        column = std::max(column, lettering.width_of(one.label));
    }
    int const top = gap + lettering.line_height();
    int const error_top = top + reference.height + gap;
    int const error_height = std::max(reference.height, 2 * lettering.line_height());
    Picture canvas(gap + (column + gap) * (1 + static_cast<int>(shown.size())), error_top + error_height + gap);
    std::fill(canvas.rgba.begin(), canvas.rgba.end(), std::uint8_t(255));

    Palette const palette = inferno();
    lettering.draw(canvas, gap, gap, "reference");
    paste(canvas, gap, top, reference);
    draw_scale(canvas, gap, error_top, reference.width, lettering, palette);
    int left = gap;
    for (Labelled const& one : shown) {
        left += column + gap;
        lettering.draw(canvas, left, gap, one.label);
        paste(canvas, left, top, one.picture);
        paste(canvas, left, error_top, error_picture(reference, one.picture, palette));
    }
    return canvas;
}

} // namespace framelet::bench
