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

using RowOfSamples [[gnu::vector_size(framelet_side)]] = std::uint8_t;

std::uint8_t mean_of_four(unsigned a, unsigned b, unsigned c, unsigned d) {
    return static_cast<std::uint8_t>((a + b + c + d + 2) >> 2);
}

/// The picture is larger than the caches near the processor, and its rows are far apart: they are asked for in time.
constexpr std::size_t rows_ahead = 12;
constexpr int to_read = 0, to_write = 1;
template <int use>
void prefetch_row(std::uint8_t const* row, std::size_t size) {
    for (std::size_t at = 0; at < size; at += cache_line) {
        __builtin_prefetch(row + at, use);
    }
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

/// Each value gets the sample that covers it. `Lane` holds a row of the values that a sample covers.
template <typename Lane>
void put_squares(SamplePlane const& samples, std::uint8_t* to, std::size_t stride) {
    constexpr std::size_t pitch = sizeof(Lane);
    constexpr Lane ones = static_cast<Lane>(~std::uint64_t{0}) / 255;
    using Row [[gnu::vector_size(framelet_side * pitch)]] = Lane;
    SamplePlane rows;
    to_rows(samples.data(), rows.data(), framelet_side);
    for (std::size_t y = 0; y < framelet_side; ++y) {
        RowOfSamples row;
        std::memcpy(&row, rows.data() + y * framelet_side, sizeof row);
        Row const spread = __builtin_convertvector(row, Row) * ones;
        for (std::size_t copy = 0; copy < pitch; ++copy, to += stride) {
            prefetch_row<to_write>(to + rows_ahead * stride, sizeof spread);
            std::memcpy(to, &spread, sizeof spread);
        }
    }
}

void put_squares_of_coarsest(SamplePlane const& samples, std::uint8_t* to, std::size_t stride) {
    constexpr std::size_t pitch = 16;
    SamplePlane rows;
    to_rows(samples.data(), rows.data(), framelet_side);
    for (std::size_t y = 0; y < framelet_side; ++y) {
        for (std::size_t copy = 0; copy < pitch; ++copy, to += stride) {
            prefetch_row<to_write>(to + rows_ahead * stride, framelet_side * pitch);
            for (std::size_t x = 0; x < framelet_side; ++x) {
                std::memset(to + x * pitch, rows[y * framelet_side + x], pitch);
            }
        }
    }
}

/// Each value gets the mean of its four samples.
void put_means(SamplePlane const& samples, std::uint8_t* to, std::size_t stride) {
    std::array<std::uint8_t, framelet_samples / 4> means;
    for (std::size_t k = 0; k < means.size(); ++k) { // many at a time
        std::uint32_t four;
        std::memcpy(&four, &samples[4 * k], sizeof four);
        means[k] = mean_of_four(four & 255, four >> 8 & 255, four >> 16 & 255, four >> 24);
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
        return put_squares<std::uint16_t>(samples, to, stride);
    case 4:
        return put_squares<std::uint32_t>(samples, to, stride);
    case 8:
        return put_squares<std::uint64_t>(samples, to, stride);
    default:
        return put_squares_of_coarsest(samples, to, stride);
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
    Line grey_line;
    grey_line.values.fill(grey);
    for (auto& values : values_) {
        values.assign(at(0, height_) / grey_line.values.size(), grey_line);
    }
}

HeldPicture::Place HeldPicture::place(Tile tile) const {
    PixelRect const rect = plane_.tile_rect(tile);
    return {values_per_pixel * rect.left, values_per_pixel * rect.top, values_per_pixel * rect.width()};
}

void HeldPicture::expect(Tile tile) const {
    Place const from = place(tile);
    for (std::size_t plane = 0; plane < values_.size(); ++plane) {
        Source const rows = source(from, {}, plane);
        auto const pitch = static_cast<std::size_t>(rows.pitch);
        auto const side = static_cast<std::size_t>(from.side);
        if (pitch <= 2) {
            for (std::size_t y = 0; y < side; ++y) {
                prefetch_row<to_read>(rows.first + y * rows.stride, side);
            }
        } else { // of the rows that a sample covers only the two in the middle are read
            for (std::size_t y = pitch / 2 - 1; y < side; y += pitch) {
                prefetch_row<to_read>(rows.first + y * rows.stride, side);
                prefetch_row<to_read>(rows.first + (y + 1) * rows.stride, side);
            }
        }
    }
}

void HeldPicture::predict(Tile tile, PictureVector vector, DisplayFramelet& out) const {
    Place const from = place(tile);
    std::size_t plane = 0;
    for_each_plane([&](auto const samples) { fetch(source(from, vector, plane++), out.*samples); });
}

void HeldPicture::write(DisplayFramelet const& framelet) {
    Place const to = place(framelet.tile);
    std::size_t plane = 0;
    for_each_plane([&](auto const samples) {
        std::uint8_t* const first = reinterpret_cast<std::uint8_t*>(values_[plane++].data()) + at(to.left, to.top);
        put(framelet.*samples, to.side / framelet_side, first, static_cast<std::size_t>(width_));
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
