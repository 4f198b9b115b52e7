#include "protocol/held_picture.h"

#include <algorithm>
#include <cstring>

#include "common/error.h"
#include "protocol/exact_planes.h"
#include "protocol/morton_rows.h"

namespace framelet {
namespace {

constexpr std::uint8_t grey = 128;
constexpr int values_per_pixel = 2;

std::uint8_t mean_of_four(unsigned a, unsigned b, unsigned c, unsigned d) {
    return static_cast<std::uint8_t>((a + b + c + d + 2) >> 2);
}

/// Two rows of two samples for each value.
void fetch_doubled(HeldPicture::Source const& from, SamplePlane& samples) {
    std::array<std::uint8_t, framelet_samples / 4> values;
    from_rows(from.first, from.stride, values.data(), values.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
        std::uint32_t const four = values[k] * 0x01010101u;
        std::memcpy(&samples[4 * k], &four, sizeof four);
    }
}

/// The mean of the four values about each sample. `Lane` holds a row of those that a sample covers.
template <typename Lane>
void fetch_means(HeldPicture::Source const& from, SamplePlane& rows) {
    constexpr std::size_t pitch = sizeof(Lane);
    constexpr unsigned left = 8 * (pitch / 2 - 1), right = left + 8;
    for (std::size_t y = 0; y < framelet_side; ++y) {
        std::uint8_t const* const upper = from.first + (y * pitch + pitch / 2 - 1) * from.stride;
        std::uint8_t const* const lower = upper + from.stride;
        for (std::size_t x = 0; x < framelet_side; ++x) { // many at a time
            Lane above, below;
            std::memcpy(&above, upper + x * pitch, pitch);
            std::memcpy(&below, lower + x * pitch, pitch);
            auto const sum = static_cast<std::uint16_t>((above >> left & 255) + (above >> right & 255) +
                                                        (below >> left & 255) + (below >> right & 255));
            rows[y * framelet_side + x] = static_cast<std::uint8_t>((sum + 2) >> 2);
        }
    }
}

void fetch_means_of_coarsest(HeldPicture::Source const& from, SamplePlane& rows) {
    constexpr std::size_t pitch = 16;
    for (std::size_t y = 0; y < framelet_side; ++y) {
        std::uint8_t const* const upper = from.first + (y * pitch + pitch / 2 - 1) * from.stride + pitch / 2 - 1;
        std::uint8_t const* const lower = upper + from.stride;
        for (std::size_t x = 0; x < framelet_side; ++x) {
            rows[y * framelet_side + x] =
                mean_of_four(upper[x * pitch], upper[x * pitch + 1], lower[x * pitch], lower[x * pitch + 1]);
        }
    }
}

void fetch(HeldPicture::Source const& from, SamplePlane& samples) {
    SamplePlane rows;
    switch (from.pitch) {
    case 0:
        fetch_doubled(from, samples);
        return;
    case 1:
        from_rows(from.first, from.stride, samples.data());
        return;
    case 2:
        fetch_means<std::uint16_t>(from, rows);
        break;
    case 4:
        fetch_means<std::uint32_t>(from, rows);
        break;
    case 8:
        fetch_means<std::uint64_t>(from, rows);
        break;
    default:
        fetch_means_of_coarsest(from, rows);
    }
    from_rows(rows.data(), framelet_side, samples.data());
}

/// Each value gets the sample that covers it.
template <std::size_t pitch>
void put_squares(SamplePlane const& samples, std::uint8_t* to, std::size_t stride) {
    SamplePlane rows;
    to_rows(samples.data(), rows.data(), framelet_side);
    for (std::size_t y = 0; y < framelet_side; ++y, to += pitch * stride) {
        for (std::size_t x = 0; x < framelet_side; ++x) {
            std::memset(to + x * pitch, rows[y * framelet_side + x], pitch);
        }
        for (std::size_t copy = 1; copy < pitch; ++copy) {
            std::memcpy(to + copy * stride, to, framelet_side * pitch);
        }
    }
}

/// Each value gets the mean of its four samples.
void put_means(SamplePlane const& samples, std::uint8_t* to, std::size_t stride) {
    std::array<std::uint8_t, framelet_samples / 4> means;
    for (std::size_t k = 0; k < means.size(); ++k) {
        means[k] = mean_of_four(samples[4 * k], samples[4 * k + 1], samples[4 * k + 2], samples[4 * k + 3]);
    }
    to_rows(means.data(), to, stride, means.size());
}

void put(SamplePlane const& samples, int pitch, std::uint8_t* to, std::size_t stride) {
    switch (pitch) {
    case 0:
        return put_means(samples, to, stride);
    case 1:
        return to_rows(samples.data(), to, stride);
    case 2:
        return put_squares<2>(samples, to, stride);
    case 4:
        return put_squares<4>(samples, to, stride);
    case 8:
        return put_squares<8>(samples, to, stride);
    default:
        return put_squares<16>(samples, to, stride);
    }
}

} // namespace

void HeldPicture::show(Viewport viewport) {
    FRAMELET_CHECK(holds(viewport));
    if (shows(viewport)) {
        return;
    }
    plane_ = ImagePlane(viewport);
    int const coarsest = plane_.side() >> plane_.min_depth();
    auto const rounded_up = [&](int pixels) { return (pixels + coarsest - 1) / coarsest * coarsest; };
    width_ = values_per_pixel * rounded_up(viewport.width);
    height_ = values_per_pixel * rounded_up(viewport.height);
    for (auto& values : values_) {
        values.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), grey);
    }
}

HeldPicture::Source HeldPicture::source(Tile tile, PictureVector vector, std::size_t plane) const {
    PixelRect const rect = plane_.tile_rect(tile);
    int const side = values_per_pixel * rect.width();
    int const left = std::clamp(values_per_pixel * rect.left + vector.x, 0, width_ - side);
    int const top = std::clamp(values_per_pixel * rect.top + vector.y, 0, height_ - side);
    auto const stride = static_cast<std::size_t>(width_);
    return {values_[plane].data() + static_cast<std::size_t>(top) * stride + static_cast<std::size_t>(left), stride,
            side / framelet_side};
}

void HeldPicture::predict(Tile tile, PictureVector vector, DisplayFramelet& out) const {
    std::size_t plane = 0;
    for_each_plane([&](auto const samples) { fetch(source(tile, vector, plane++), out.*samples); });
}

void HeldPicture::write(DisplayFramelet const& framelet) {
    std::size_t plane = 0;
    for_each_plane([&](auto const samples) {
        Source const to = source(framelet.tile, {}, plane);
        auto const first = static_cast<std::size_t>(to.first - values_[plane].data());
        put(framelet.*samples, to.pitch, values_[plane].data() + first, to.stride);
        ++plane;
    });
}

void HeldPicture::take(std::span<DisplayFramelet const> framelets) {
    for (int depth = plane_.min_depth(); depth <= plane_.max_depth(); ++depth) {
        for (DisplayFramelet const& framelet : framelets) {
            if (framelet.tile.depth() == depth) {
                write(framelet);
            }
        }
    }
}

} // namespace framelet
