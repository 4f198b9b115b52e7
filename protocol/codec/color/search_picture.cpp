#include "protocol/codec/color/search_picture.h"

#include <algorithm>
#include <cstring>

#include "protocol/codec/entropy/morton_rows.h"

namespace framelet {
namespace {

/// Each value gets the sample that covers it. `Lane` holds a row of the values that a sample covers.
template <typename Lane>
void put_squares(SamplePlane const& samples, std::uint8_t* to, std::size_t stride) {
    constexpr std::size_t pitch = sizeof(Lane);
    constexpr Lane ones = static_cast<Lane>(~std::uint64_t{0}) / 255;
    using RowOfSamples [[gnu::vector_size(framelet_side)]] = std::uint8_t;
    using Row [[gnu::vector_size(framelet_side * pitch)]] = Lane;
    SamplePlane rows;
    to_rows(samples.data(), rows.data(), framelet_side);
    for (std::size_t y = 0; y < framelet_side; ++y) {
        RowOfSamples row;
        std::memcpy(&row, rows.data() + y * framelet_side, sizeof row);
        Row const spread = __builtin_convertvector(row, Row) * ones;
        for (std::size_t copy = 0; copy < pitch; ++copy, to += stride) {
            std::memcpy(to, &spread, sizeof spread);
        }
    }
}

/// Writes the samples of a framelet. `pitch`: values from sample to sample; 0: two samples a value.
void put(SamplePlane const& samples, int pitch, std::uint8_t* to, std::size_t stride) {
    switch (pitch) {
    case 0:
        return put_means(samples, to, stride);
    case 1:
        return to_rows(samples.data(), to, stride);
    case 2:
        return put_squares<std::uint16_t>(samples, to, stride);
    default:
        return put_squares<std::uint32_t>(samples, to, stride);
    }
}

} // namespace

void SearchPicture::copy(PointGrids const& grids, std::size_t plane) {
    width_ = grids.width();
    height_ = grids.height();
    values_.resize(at(0, height_) / cache_line);
    for (int x = 0; x < width_; x += framelet_side) {
        PointRows rows(grids, x, 0, PointGrids::mixed_levels, 0);
        for (int y = 0; y < height_; ++y) {
            PointRow const row = rows.at(y)[plane];
            std::memcpy(values() + at(x, y), &row, sizeof row);
        }
    }
    coarse_values_.resize(coarse_at(0, height_));
    for (int y = 0; y < height_; y += framelet_side) {
        for (int x = 0; x < width_; x += framelet_side) {
            put_coarse_points(x, y, framelet_side);
        }
    }
    coarse_only_.assign(static_cast<std::size_t>(block_columns() * block_rows()), 0);
}

/// Gives each coarse point the first of the 4x4 points that it stands for: a search reads of each coarse sample the
/// first coarse point behind its middle.
void SearchPicture::put_coarse_points(int left, int top, int side) {
    for (int y = top; y < top + side; y += coarse) {
        std::uint8_t const* const row = values() + at(left, y);
        std::uint8_t* const to = &coarse_values_[coarse_at(left, y)];
        for (int i = 0; i < side / coarse; ++i) {
            to[i] = row[i * coarse];
        }
    }
}

void SearchPicture::write(Samples const& samples, int left, int top, int side) {
    if (is_coarse(side)) {
        put(samples, side / framelet_side / coarse, &coarse_values_[coarse_at(left, top)], coarse_stride());
        for (int row = top / block_side; row < (top + side) / block_side; ++row) {
            for (int column = left / block_side; column < (left + side) / block_side; ++column) {
                is_coarse_only(column, row) = 1;
            }
        }
        return;
    }
    std::uint8_t& coarse_only = is_coarse_only(left / block_side, top / block_side);
    if (coarse_only != 0 && side < block_side) {
        spread(left / block_side, top / block_side);
    }
    coarse_only = 0;
    put(samples, side / framelet_side, values() + at(left, top), static_cast<std::size_t>(width_));
    put_coarse_points(left, top, side);
}

/// Gives each point of a block the value of the coarse one that stands for it. Where there are coarse framelets the
/// picture consists of whole blocks.
void SearchPicture::spread(int column, int row) {
    using Points [[gnu::vector_size(block_side)]] = std::uint32_t;
    using CoarsePoints [[gnu::vector_size(block_side / coarse)]] = std::uint8_t;
    static_assert(coarse == sizeof(std::uint32_t));
    int const left = column * block_side, top = row * block_side;
    for (int y = top; y < top + block_side; y += coarse) {
        CoarsePoints points;
        std::memcpy(&points, &coarse_values_[coarse_at(left, y)], sizeof points);
        Points const spread = __builtin_convertvector(points, Points) * 0x01010101u;
        for (int copy = 0; copy < coarse; ++copy) {
            std::memcpy(values() + at(left, y + copy), &spread, sizeof spread);
        }
    }
    is_coarse_only(column, row) = 0;
}

void SearchPicture::prepare(int left, int top, int side) {
    int const column = left / block_side, row = top / block_side; // none but coarse framelets lie in several
    if (!is_coarse(side) && is_coarse_only(column, row) != 0) {
        spread(column, row);
    }
}

void SearchPicture::expect(int left, int top, int side) const {
    if (is_coarse(side)) {
        return; // they are few enough to stay in a cache
    }
    // The search looks at the middle one alone of the rows that a sample covers.
    int const pitch = std::max(side / framelet_side, 1);
    for (int y = pitch / 2; y < side; y += pitch) {
        __builtin_prefetch(values() + at(left, top + y)); // all of it: no row is wider than a line
    }
}

} // namespace framelet
