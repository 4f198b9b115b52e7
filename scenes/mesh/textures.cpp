#include "scenes/mesh/textures.h"

#include <algorithm>
#include <cmath>

#include "scenes/mesh/geometry.h"
#include "scenes/mesh/png_encoder.h"

namespace framelet {
namespace {

/// The value as a byte, in `levels` steps from 0 to 255: fewer steps make a smaller file.
std::uint8_t stepped(double value, int levels) {
    double const step = std::round(std::clamp(value, 0.0, 1.0) * (levels - 1)) / (levels - 1);
    return static_cast<std::uint8_t>(std::lround(step * 255));
}

/// A pixel's place in [0, 1)^2, scaled to `cells` lattice cells.
D2 cell_of(TexturePixels const& pixels, int x, int y, int cells) {
    return D2(x + 0.5, y + 0.5) / D2(pixels.width, pixels.height) * double(cells);
}

void set_color(std::uint8_t* pixel, D3 color, int levels = 32) {
    for (int c = 0; c < 3; ++c) {
        pixel[c] = stepped(color[c], levels);
    }
}

} // namespace

std::string asphalt_texture() {
    TexturePixels pixels(256, 256, 1);
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            double const stones = value_noise(1, cell_of(pixels, x, y, 96), 96);
            double const stains = fractal_noise(2, cell_of(pixels, x, y, 4), 3, 4);
            double const grit = random_unit(3, x, y) < 0.02 ? 0.25 : 0.0;
            *pixels.at(x, y) = stepped(0.72 + 0.13 * stones + 0.08 * stains + grit, 24);
        }
    }
    return encode_png(pixels);
}

std::string grass_texture() {
    TexturePixels pixels(256, 256, 1);
    std::fill(pixels.bytes.begin(), pixels.bytes.end(), stepped(0.5, 24));
    for (int blade = 0; blade < 5200; ++blade) {
        double const angle = 2 * pi * random_unit(10, blade);
        double const length = 6 + 10 * random_unit(11, blade);
        double const light = 0.45 + 0.55 * blade / 5200.0 * (0.5 + 0.5 * random_unit(12, blade));
        D2 const start(256 * random_unit(13, blade), 256 * random_unit(14, blade));
        for (double along = 0; along < length; along += 0.7) {
            D2 const at = start + along * D2(std::cos(angle), std::sin(angle));
            *pixels.at(static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y))) =
                stepped(light * (0.75 + 0.25 * along / length), 24);
        }
    }
    return encode_png(pixels);
}

std::string checker_texture() {
    TexturePixels pixels(128, 128, 1);
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            bool const light = (x < 64) == (y < 64);
            double const wear = 0.05 * fractal_noise(20, cell_of(pixels, x, y, 8), 3, 8);
            *pixels.at(x, y) = stepped((light ? 0.9 : 0.3) + wear, 32);
        }
    }
    return encode_png(pixels);
}

std::string facade_texture() {
    TexturePixels pixels(128, 128, 3);
    auto const inside = [](int x, int y, int left, int top, int right, int bottom) {
        return x >= left && x < right && y >= top && y < bottom;
    };
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            double const plaster = 0.05 * fractal_noise(30, cell_of(pixels, x, y, 16), 2, 16);
            D3 color = D3(0.82, 0.78, 0.70) + plaster;
            if (y >= 122) {
                color = D3(0.62, 0.58, 0.52); // cornice between the floors
            }
            if (inside(x, y, 30, 92, 98, 98)) {
                color = D3(0.70, 0.68, 0.64); // sill
            }
            if (inside(x, y, 30, 98, 98, 102)) {
                color = D3(0.5, 0.47, 0.42); // its shadow
            }
            if (inside(x, y, 34, 24, 94, 92)) {
                color = D3(0.93, 0.93, 0.90); // frame
            }
            bool const pane = inside(x, y, 38, 28, 62, 52) || inside(x, y, 66, 28, 90, 52) ||
                              inside(x, y, 38, 56, 62, 88) || inside(x, y, 66, 56, 90, 88);
            if (pane) {
                color = D3(0.16, 0.20, 0.25) + 0.0022 * double(92 - y);
            }
            set_color(pixels.at(x, y), color, 48);
        }
    }
    return encode_png(pixels);
}

std::string brick_texture() {
    TexturePixels pixels(256, 256, 1);
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            int const course = y / 32;
            int const shifted = (x + (course % 2) * 32) % 256;
            bool const mortar = y % 32 < 3 || shifted % 64 < 3;
            double const tone = 0.5 + 0.25 * random_unit(40, course, shifted / 64);
            double const grain = 0.06 * value_noise(41, cell_of(pixels, x, y, 64), 64);
            *pixels.at(x, y) = stepped(mortar ? 0.9 : tone + grain, 24);
        }
    }
    return encode_png(pixels);
}

std::string plank_texture() {
    TexturePixels pixels(128, 256, 1);
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            int const plank = x / 32;
            double const tone = 0.6 + 0.2 * random_unit(50, plank);
            double const grain = 0.14 * value_noise(51, {x * 64 / 128.0, y * 4 / 256.0}, 64);
            *pixels.at(x, y) = stepped(x % 32 < 2 ? 0.2 : tone + grain, 24);
        }
    }
    return encode_png(pixels);
}

std::string sky_texture() {
    TexturePixels pixels(512, 128, 3);
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            double const up = 1 - (y + 0.5) / 128;
            D3 const clear = glm::mix(D3(0.80, 0.88, 0.95), D3(0.42, 0.58, 0.80), std::pow(up, 0.6));
            // Clouds are seen ever flatter towards the horizon.
            D2 const at(x * 8 / 512.0, 2.2 / (0.18 + up));
            double const cover = fractal_noise(90, at, 5, 8, 0.55);
            double const cloud = std::clamp((cover - 0.02) * 3.2, 0.0, 1.0) * std::clamp(up * 6, 0.0, 1.0);
            double const shade = 0.93 + 0.06 * std::clamp(1 - cover * 2, 0.0, 1.0);
            set_color(pixels.at(x, y), glm::mix(clear, D3(shade), 0.85 * cloud), 128);
        }
    }
    return encode_png(pixels);
}

std::string slab_texture() {
    TexturePixels pixels(256, 256, 1);
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            bool const joint = x % 128 < 3 || y % 128 < 3;
            double const tone = 0.72 + 0.16 * random_unit(95, x / 128, y / 128);
            double const grain = 0.05 * value_noise(96, cell_of(pixels, x, y, 128), 128) +
                                 0.05 * fractal_noise(97, cell_of(pixels, x, y, 8), 3, 8);
            *pixels.at(x, y) = stepped(joint ? 0.4 : tone + grain, 24);
        }
    }
    return encode_png(pixels);
}

std::string globe_texture() {
    TexturePixels pixels(512, 256, 3);
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            D2 const at(x * 8 / 512.0, y * 8 / 512.0);
            double const height = fractal_noise(60, at, 6, 8, 0.6);
            double const latitude = std::abs(y - 127.5) / 128;
            D3 color(0.07, 0.20 + 0.06 * height, 0.42 + 0.2 * height);
            if (height > 0.05) {
                double const dry = fractal_noise(70, at, 3, 8);
                color = dry > 0.1 ? D3(0.72, 0.62, 0.38) : D3(0.27, 0.40, 0.17);
                color *= 0.8 + 0.6 * height;
            }
            if (latitude + 0.2 * height > 0.86) {
                color = D3(0.93, 0.95, 0.98);
            }
            bool const line = y % 16 == 8 || (x % 32 == 0 && latitude < 0.9);
            bool const equator = y == 127 || y == 128 || (x % 128) < 2;
            set_color(pixels.at(x, y), equator ? D3(0.95, 0.25, 0.15) : line ? color * 0.45 + 0.5 : color, 20);
        }
    }
    return encode_png(pixels);
}

std::string stripe_texture() {
    TexturePixels pixels(128, 128, 3);
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            bool const dark = y % 64 < 24;
            bool const line = x % 128 < 6;
            double const weave = (x / 2 + y / 2) % 2 == 0 ? 0.93 : 1.0;
            D3 const color = line ? D3(0.85, 0.25, 0.18) : dark ? D3(0.13, 0.17, 0.34) : D3(0.92, 0.91, 0.88);
            set_color(pixels.at(x, y), color * weave);
        }
    }
    return encode_png(pixels);
}

std::string flag_texture() {
    TexturePixels pixels(384, 256, 3);
    D2 const middle(146, 128);
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            bool const light = y * 9 / pixels.height % 2 == 1;
            D3 color = light ? D3(0.94, 0.92, 0.86) : D3(0.05, 0.36, 0.48);
            D2 const out = D2(x + 0.5, y + 0.5) - middle;
            double const distance = glm::length(out);
            double const ray = std::abs(std::remainder(std::atan2(out.x, -out.y), pi / 4)); // from the nearest of eight
            if (distance < 92) {
                color = distance < 84 ? D3(0.80, 0.16, 0.12) : D3(0.97, 0.80, 0.25);
            }
            if (distance < 76 - 100 * ray || distance < 26) {
                color = D3(0.97, 0.80, 0.25);
            }
            if (distance < 18) {
                color = D3(0.05, 0.36, 0.48);
            }
            bool const hem = x < 8 || x >= 378 || y < 5 || y >= 251;
            double const weave = (x + y) % 2 == 0 ? 0.96 : 1.0;
            set_color(pixels.at(x, y), color * (hem ? 0.8 : weave));
        }
    }
    return encode_png(pixels);
}

std::string leaf_texture() {
    TexturePixels pixels(128, 128, 4);
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            std::uint8_t* const pixel = pixels.at(x, y);
            set_color(pixel, D3(0.40, 0.54, 0.20)); // under the mask too: filtering reaches there
        }
    }
    auto const draw_leaf = [&](D2 base, double angle, double length, double tone) {
        D2 const axis(std::cos(angle), std::sin(angle));
        for (int y = 0; y < 128; ++y) {
            for (int x = 0; x < 128; ++x) {
                D2 const offset = D2(x + 0.5, y + 0.5) - base;
                double const along = glm::dot(offset, axis) / length;
                double const across = (offset.x * axis.y - offset.y * axis.x) / length;
                if (along < 0 || along > 1 || std::abs(across) > 0.40 * std::sin(pi * along) * (1 - 0.5 * along)) {
                    continue;
                }
                double const vein = std::abs(across) < 0.03 ? 0.12 : 0.0;
                set_color(pixels.at(x, y), D3(0.50, 0.66, 0.24) * (tone + vein), 32);
                pixels.at(x, y)[3] = 255;
            }
        }
    };
    for (int x = 0; x < 128; ++x) { // the twig
        for (int y = 62; y < 66; ++y) {
            set_color(pixels.at(x, y), D3(0.36, 0.27, 0.16));
            pixels.at(x, y)[3] = x < 104 ? 255 : 0;
        }
    }
    for (int pair = 0; pair < 5; ++pair) {
        double const x = 6 + 20 * pair;
        draw_leaf({x, 62}, radians(-58 + 4 * pair), 56 - 3 * pair, 0.8 + 0.12 * (pair % 3));
        draw_leaf({x + 8, 66}, radians(60 - 4 * pair), 54 - 3 * pair, 0.95 - 0.1 * (pair % 2));
    }
    draw_leaf({94, 64}, 0, 33, 1.05);
    return encode_png(pixels);
}

} // namespace framelet
