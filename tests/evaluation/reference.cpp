#include "tests/evaluation/reference.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include <tbb/parallel_for.h>
#include <unistd.h>

#include "common/color.h"
#include "common/files/image_io.h"
#include "common/files/picture_writer.h"
#include "common/mix_bits.h"

namespace framelet::bench {
namespace {

/// Side, in pixels, of a block that is rendered together: as many pixels as a packet has lanes, close to each other.
constexpr int block = 4;

float fraction(std::uint32_t bits) {
    return static_cast<float>(bits >> 8) * 0x1p-24f;
}

template <class... Values>
std::string printed(char const* format, Values... values) {
    char text[160];
    std::snprintf(text, sizeof(text), format, values...);
    return text;
}

std::string turn_name(CameraTurn const& turn) {
    return turn.turns() ? printed("-turn%gx%g", turn.degrees_per_second, turn.reach_degrees) : "";
}

std::uint64_t hash_of_file(std::filesystem::path const& file) {
    std::ifstream stream(file, std::ios::binary);
    std::uint64_t hash = 0xcbf29ce484222325u; // FNV-1a
    char buffer[65536];
    while (stream.read(buffer, sizeof(buffer)) || stream.gcount() > 0) {
        for (std::streamsize i = 0; i < stream.gcount(); ++i) {
            hash = (hash ^ static_cast<unsigned char>(buffer[i])) * 0x100000001b3u;
        }
    }
    return hash;
}

} // namespace

Picture render_reference(BenchScene const& scene, Viewport viewport, int samples_per_side) {
    Picture picture(viewport.width, viewport.height);
    ViewRays const rays = make_view_rays(scene.camera, viewport);
    int const strata = samples_per_side * samples_per_side;
    float const stratum = 1 / static_cast<float>(samples_per_side);
    int const columns = (viewport.width + block - 1) / block;
    int const rows = (viewport.height + block - 1) / block;
    tbb::parallel_for(0, rows, [&](int row) {
        std::vector<Vec2> positions(static_cast<std::size_t>(columns * block * block * strata));
        std::vector<float> const spacings(positions.size(), stratum);
        std::vector<Vec3> radiance(positions.size());
        std::size_t next = 0;
        for (int column = 0; column < columns; ++column) {
            for (int s = 0; s < strata; ++s) {
                for (int i = 0; i < block * block; ++i) {
                    int const x = column * block + i % block;
                    int const y = row * block + i / block;
                    std::uint32_t const h = mix_bits(mix_bits(static_cast<std::uint32_t>(y * viewport.width + x)) +
                                                     static_cast<std::uint32_t>(s));
                    Vec2 const in_stratum(fraction(h), fraction(mix_bits(h ^ 0x9e3779b9u)));
                    Vec2 const corner(s % samples_per_side, s / samples_per_side);
                    positions[next++] = Vec2(x, y) + (corner + in_stratum) * stratum;
                }
            }
        }
        render_samples(*scene.render_scene, rays, positions, spacings, radiance);
        for (int column = 0; column < columns; ++column) {
            for (int i = 0; i < block * block; ++i) {
                int const x = column * block + i % block;
                int const y = row * block + i / block;
                if (x >= viewport.width || y >= viewport.height) {
                    continue;
                }
                // Each sample is tone-mapped as the display would show it; the filter works on the display's light.
                Vec3 light(0);
                for (int s = 0; s < strata; ++s) {
                    std::size_t const sample = static_cast<std::size_t>((column * strata + s) * block * block + i);
                    light += tone_map(radiance[sample] * scene.exposure);
                }
                std::uint8_t* const pixel = picture.row(y) + static_cast<std::ptrdiff_t>(x) * 4;
                for (int c = 0; c < 3; ++c) {
                    pixel[c] = srgb_byte_from_linear(light[c] / static_cast<float>(strata));
                }
                pixel[3] = 255;
            }
        }
    });
    return picture;
}

Reference::Reference(BenchScene& scene, ReferenceParameters const& p, std::filesystem::path const& cache)
    : folder_(cache /
              (scene.name + turn_name(scene.turn) +
               printed("-%016llx-c%d-%dx%d-%dspp-%ghz-from%g",
                       static_cast<unsigned long long>(hash_of_file(scene.file)), static_cast<int>(scene.scene_camera),
                       p.viewport.width, p.viewport.height, p.samples_per_side * p.samples_per_side, p.rate, p.start))),
      count_(static_cast<std::size_t>(std::lround(p.seconds * p.rate))) {
    std::filesystem::create_directories(folder_);
    auto const render = [&](std::size_t index) {
        pose_at(scene, clock_at(p.clock_settings, p.start, static_cast<double>(index) / p.rate));
        return render_reference(scene, p.viewport, p.samples_per_side);
    };
    bool stale = false;
    for (std::size_t const probe : {std::size_t(0), count_ / 2}) {
        if (probe < count_ && std::filesystem::exists(file(probe))) {
            stale = stale || picture(probe) != render(probe);
        }
    }
    bool const terminal = isatty(STDERR_FILENO) != 0;
    std::size_t rendered = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        if (stale || !std::filesystem::exists(file(i))) {
            // The file has a name of this process first, so that a process that is stopped half-way, or runs twice,
            // leaves no half picture.
            auto const unfinished = folder_ / printed("unfinished-%d.png", static_cast<int>(getpid()));
            write_png(unfinished, render(i));
            std::filesystem::rename(unfinished, file(i));
            ++rendered;
            // A terminal gets a line that counts up, a log gets one line for each quarter.
            bool const quarter = (i + 1) * 4 / count_ != i * 4 / count_;
            if (terminal || quarter) {
                std::fprintf(stderr, "%sreference of %s: %zu of %zu%s", terminal ? "\r" : "", scene.name.c_str(), i + 1,
                             count_, terminal ? "" : "\n");
            }
        }
    }
    if (terminal && rendered > 0) {
        std::fputc('\n', stderr);
    }
}

Picture Reference::picture(std::size_t index) const {
    return read_picture(file(index));
}

std::filesystem::path Reference::file(std::size_t index) const {
    return folder_ / printed("%05zu.png", index);
}

std::filesystem::path default_reference_cache() {
    if (char const* const cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) {
        return std::filesystem::path(cache) / "framelet" / "reference";
    }
    char const* const home = std::getenv("HOME");
    return std::filesystem::path(home ? home : ".") / ".cache" / "framelet" / "reference";
}

} // namespace framelet::bench
