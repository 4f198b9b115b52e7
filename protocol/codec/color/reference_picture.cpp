#include "protocol/codec/color/reference_picture.h"

#include <array>
#include <cstring>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "protocol/codec/color/exact_planes.h"
#include "protocol/codec/entropy/morton_rows.h"

namespace framelet {
namespace {

constexpr std::uint8_t grey = 128;
constexpr int values_per_pixel = 2;

/// Rounds a viewport up to whole tiles of the coarsest level.
Viewport rounded_up(ImagePlane const& plane) {
    int const coarsest = plane.side() >> plane.min_depth();
    auto const up = [coarsest](int pixels) { return (pixels + coarsest - 1) / coarsest * coarsest; };
    return {up(plane.viewport().width), up(plane.viewport().height)};
}

/// Fetches samples from values twice as far apart: each value becomes a block of 2x2 samples.
void fetch_doubled(std::uint8_t const* first, std::size_t stride, SamplePlane& samples) {
    std::array<std::uint8_t, framelet_samples / 4> values;
    quarter_from_rows(first, stride, values.data());
    for (std::size_t k = 0; k < values.size(); ++k) {
        std::uint32_t const four = values[k] * 0x01010101u;
        std::memcpy(&samples[4 * k], &four, sizeof four);
    }
}

/// Fetches for each sample the mean of the four values about its centre. `Lane` holds a row of those that a sample
/// covers.
template <typename Lane>
void fetch_means(std::uint8_t const* first, std::size_t stride, SamplePlane& rows) {
    constexpr std::size_t pitch = sizeof(Lane);
    constexpr unsigned left = 8 * (pitch / 2 - 1), right = left + 8;
    for (std::size_t y = 0; y < framelet_side; ++y) {
        std::uint8_t const* const upper = first + (y * pitch + pitch / 2 - 1) * stride;
        std::uint8_t const* const lower = upper + stride;
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

void fetch_means_of_coarsest(std::uint8_t const* first, std::size_t stride, SamplePlane& rows) {
    constexpr std::size_t pitch = 16;
    for (std::size_t y = 0; y < framelet_side; ++y) {
        std::uint8_t const* const upper = first + (y * pitch + pitch / 2 - 1) * stride + pitch / 2 - 1;
        std::uint8_t const* const lower = upper + stride;
        for (std::size_t x = 0; x < framelet_side; ++x) {
            rows[y * framelet_side + x] =
                mean_of_four(upper[x * pitch], upper[x * pitch + 1], lower[x * pitch], lower[x * pitch + 1]);
        }
    }
}

/// Fetches samples 2^pitch values apart, of a level that counts in all of their square, which begins where one of its
/// values does.
void fetch(std::uint8_t const* first, std::size_t stride, int pitch, SamplePlane& samples) {
    SamplePlane rows;
    switch (pitch) {
    case -1:
        fetch_doubled(first, stride, samples);
        return;
    case 0:
        from_rows(first, stride, samples.data());
        return;
    case 1:
        fetch_means<std::uint16_t>(first, stride, rows);
        break;
    case 2:
        fetch_means<std::uint32_t>(first, stride, rows);
        break;
    case 3:
        fetch_means<std::uint64_t>(first, stride, rows);
        break;
    default:
        fetch_means_of_coarsest(first, stride, rows);
    }
    from_rows(rows.data(), framelet_side, samples.data());
}

using Planes = std::array<SamplePlane, PointGrids::planes>;

void put_row(PointRow const& row, SamplePlane& rows, int y) {
    std::memcpy(rows.data() + y * framelet_side, &row, sizeof row);
}

/// Looks up one point of each sample of a square, its upper left one, whatever level counts there.
void look_up(PointGrids const& points, ReferencePicture::Square const& from, int level, Planes& rows) {
    int const twice = from.pitch() < 0 ? 1 : 0, pitch = std::max(from.pitch(), 0);
    PointRows reader(points, from.left, pitch, level, twice);
    for (int y = 0; y < framelet_side; ++y) {
        auto const row = reader.at(from.top + (y << pitch >> twice));
        for (std::size_t plane = 0; plane < rows.size(); ++plane) {
            put_row(row[plane], rows[plane], y);
        }
    }
}

/// Looks up the mean of the four points about each sample's centre, whatever levels count there.
void look_up_means(PointGrids const& points, ReferencePicture::Square const& from, int level, Planes& rows) {
    using Sums [[gnu::vector_size(2 * framelet_side)]] = std::uint16_t;
    int const pitch = from.pitch();
    int const before_centre = (1 << pitch) / 2 - 1;
    int const x = from.left + before_centre;
    PointRows left(points, x, pitch, level, 0), right(points, x + 1, pitch, level, 0);
    for (int row = 0; row < framelet_side; ++row) {
        int const y = from.top + before_centre + (row << pitch);
        std::array<Sums, PointGrids::planes> sums{};
        for (int below = 0; below < 2; ++below) {
            auto const lefts = left.at(y + below), rights = right.at(y + below);
            for (std::size_t plane = 0; plane < sums.size(); ++plane) {
                sums[plane] +=
                    __builtin_convertvector(lefts[plane], Sums) + __builtin_convertvector(rights[plane], Sums);
            }
        }
        for (std::size_t plane = 0; plane < sums.size(); ++plane) {
            put_row(__builtin_convertvector((sums[plane] + 2) >> 2, PointRow), rows[plane], row);
        }
    }
}

} // namespace

std::size_t ReferencePicture::bytes(Viewport viewport) {
    Viewport const whole = rounded_up(ImagePlane(viewport));
    constexpr double bytes_per_pixel = 20.3; // 16 of the points with their levels, the rest for searches
    return static_cast<std::size_t>(bytes_per_pixel * whole.width * whole.height);
}

void ReferencePicture::show(Viewport viewport) {
    FRAMELET_CHECK(holds(viewport));
    if (shows(viewport)) {
        return;
    }
    plane_ = ImagePlane(viewport);
    Viewport const whole = rounded_up(plane_);
    points_.fill(values_per_pixel * whole.width, values_per_pixel * whole.height, grey);
    search_ = {};
}

void ReferencePicture::prepare_search(std::span<DisplayFramelet const> framelets) {
    constexpr std::size_t green = 1;
    if (!is_searched()) {
        search_.copy(points_, green);
    }
    for (DisplayFramelet const& framelet : framelets) {
        Square const at = square(framelet.tile);
        search_.prepare(at.left, at.top, at.side);
    }
}

ReferencePicture::Square ReferencePicture::square(Tile tile) const {
    PixelRect const rect = plane_.tile_rect(tile);
    return {values_per_pixel * rect.left, values_per_pixel * rect.top, values_per_pixel * rect.width()};
}

void ReferencePicture::expect(Tile tile) const {
    Square const from = square(tile);
    if (is_searched()) {
        search_.expect(from.left, from.top, from.side);
    }
    int const level = points_.level_at(from.left, from.top);
    int const side = std::max(from.side >> level, 1); // values
    bool const is_sparse = from.pitch() > level + 1; // of the rows that a sample covers only two are read
    std::size_t const stride = points_.stride(level);
    for (std::size_t plane = 0; plane < PointGrids::planes; ++plane) {
        std::uint8_t const* const first = points_.value(plane, level, from.left, from.top);
        auto const prefetch_row = [&](int y) {
            for (int x = 0; x < side; x += int{cache_line}) {
                __builtin_prefetch(first + static_cast<std::size_t>(y) * stride + x);
            }
        };
        int const step = is_sparse ? 1 << (from.pitch() - level) : 1;
        for (int y = is_sparse ? step / 2 - 1 : 0; y < side; y += step) {
            prefetch_row(y);
            if (is_sparse) {
                prefetch_row(y + 1);
            }
        }
    }
}

void ReferencePicture::predict(Tile tile, MotionVector vector, DisplayFramelet& out) const {
    Square const from = moved(square(tile), vector);
    int const pitch = from.pitch();
    int const level = points_.level_in(from.left, from.top, from.side);
    bool const is_one = level != PointGrids::mixed_levels;
    auto const begins_value = [&](int l) { return ((from.left | from.top) & ((1 << l) - 1)) == 0; };
    std::size_t plane = 0;
    if (is_one && level <= std::max(pitch, 0) && begins_value(level)) {
        for_each_plane([&](auto const samples) {
            fetch(points_.value(plane++, level, from.left, from.top), points_.stride(level), pitch - level,
                  out.*samples);
        });
        return;
    }
    Planes rows;
    // Four points about a sample's centre may be of several values, unless all are coarse.
    if (pitch < 1 || (level >= pitch && begins_value(pitch))) {
        look_up(points_, from, level, rows);
    } else {
        look_up_means(points_, from, level, rows);
    }
    for_each_plane([&](auto const samples) { from_rows(rows[plane++].data(), framelet_side, (out.*samples).data()); });
}

void ReferencePicture::write(DisplayFramelet const& framelet) {
    Square const to = square(framelet.tile);
    int const level = std::max(to.pitch(), 0);
    std::size_t plane = 0;
    for_each_plane([&](auto const samples) {
        PointGrids::Rows const rows = points_.rows(plane++, level, to.left, to.top);
        if (to.pitch() < 0) {
            put_means(framelet.*samples, rows.first, rows.stride);
        } else {
            to_rows((framelet.*samples).data(), rows.first, rows.stride);
        }
    });
    points_.set_level(level, to.left, to.top, to.side);
    if (is_searched()) {
        search_.write(framelet.green, to.left, to.top, to.side);
    }
}

void ReferencePicture::take(std::span<DisplayFramelet const> framelets) {
    order_.clear();
    for (std::uint32_t i = 0; i < framelets.size(); ++i) {
        Tile const tile = framelets[i].tile;
        order_.push_back({tile.code >> (2 * (tile.depth() - plane_.min_depth())), tile.depth(), i});
    }
    std::ranges::sort(order_);
    // What lies in different tiles of the coarsest level knows nothing of each other.
    first_.clear();
    for (std::size_t i = 0; i < order_.size(); ++i) {
        if (i == 0 || order_[i].coarsest != order_[i - 1].coarsest) {
            first_.push_back(i);
        }
    }
    first_.push_back(order_.size());
    tbb::parallel_for(std::size_t{1}, first_.size(), [&](std::size_t end) {
        for (std::size_t i = first_[end - 1]; i < first_[end]; ++i) {
            write(framelets[order_[i].index]);
        }
    });
}

} // namespace framelet
