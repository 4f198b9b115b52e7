#include "protocol/search_picture.h"

#include <cstring>

#include "protocol/morton_rows.h"

namespace framelet {
namespace {

using RowOfSamples [[gnu::vector_size(framelet_side)]] = std::uint8_t;

/// The picture is larger than the caches near the processor, and its rows are far apart: they are asked for in time.
constexpr std::size_t rows_ahead = 12;
constexpr int to_read = 0, to_write = 1;
template <int use>
void prefetch_row(std::uint8_t const* row, std::size_t size) {
    for (std::size_t at = 0; at < size; at += cache_line) {
        __builtin_prefetch(row + at, use);
    }
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

void SearchPicture::copy(PointGrids const& grids, std::size_t plane) {
    width_ = grids.width();
    values_.resize(at(0, grids.height()) / cache_line);
    for (int x = 0; x < width_; x += framelet_side) {
        PointRows rows(grids, x, 0, PointGrids::mixed_levels, 0);
        for (int y = 0; y < grids.height(); ++y) {
            PointRow const row = rows.at(y)[plane];
            std::memcpy(values() + at(x, y), &row, sizeof row);
        }
    }
}

void SearchPicture::write(Samples const& samples, int left, int top, int side) {
    put(samples, side / framelet_side, values() + at(left, top), static_cast<std::size_t>(width_));
}

void SearchPicture::expect(int left, int top, int side) const {
    // Of the rows that a sample covers only that in the middle is looked at.
    int const pitch = std::max(side / framelet_side, 1);
    auto const bytes = static_cast<std::size_t>(side);
    for (int y = pitch / 2; y < side; y += pitch) {
        prefetch_row<to_read>(values() + at(left, top + y), bytes);
    }
}

} // namespace framelet
