#include "protocol/vector_search.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "protocol/morton_rows.h"

namespace framelet {
namespace {

/// First steps of the search, half pixels, and those from which on all rows are looked at, not every second one.
constexpr int first_step = 16, exact_step = 1;
/// Where a vector that was found before leaves no more than this of a framelet, 8 of a sample, the search begins near
/// it.
constexpr int hardly_any = 2048, near_step = 4;
constexpr int farthest = 127;
/// What a vector must gain for each half pixel that it is longer: of two that are as good, the shorter one.
constexpr int length_cost = 4;

/// A row of samples.
using Row = PointRow;
using Rows = std::array<Row, framelet_side>;

Rows rows_of(SamplePlane const& samples) {
    Rows rows;
    to_rows(samples.data(), reinterpret_cast<std::uint8_t*>(rows.data()), framelet_side);
    return rows;
}

/// Values from the picture near the middles of a row of samples. `Lane` holds a row of those that a sample covers.
template <typename Lane>
Row row_at(std::uint8_t const* held) {
    constexpr std::size_t pitch = sizeof(Lane);
    using Lanes [[gnu::vector_size(framelet_side * pitch)]] = Lane;
    Lanes values;
    std::memcpy(&values, held, sizeof values);
    return __builtin_convertvector(values >> (8 * (pitch / 2)), Row);
}

Row doubled_row_at(std::uint8_t const* held) {
    using Half [[gnu::vector_size(framelet_side / 2)]] = std::uint8_t;
    Half half;
    std::memcpy(&half, held, sizeof half);
    return __builtin_shufflevector(half, half, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7);
}

Row coarsest_row_at(std::uint8_t const* held) {
    constexpr std::size_t pitch = 16;
    return point_rows::every_16th(held + pitch / 2);
}

using Sums [[gnu::vector_size(framelet_side)]] = std::uint64_t;

/// Sums of the differences in each half of a row.
Sums differences(Row const& a, Row const& b) {
#ifdef __SSE2__
    return reinterpret_cast<Sums>(_mm_sad_epu8(reinterpret_cast<__m128i>(a), reinterpret_cast<__m128i>(b)));
#else
    Row const apart = a > b ? a - b : b - a;
    Sums sums{};
    for (std::size_t x = 0; x < framelet_side; ++x) {
        sums[x / 8] += apart[x];
    }
    return sums;
#endif
}

/// Sum of differences of rows `apart` from each other, or any number above `most` where it is above that.
/// `twice_pitch` rows of the picture are two rows of samples.
template <typename RowAt>
int difference(Rows const& rows, SearchPicture::Source const& from, std::size_t apart, int most,
               std::size_t twice_pitch, RowAt const& row_at) {
    constexpr std::size_t rows_at_a_time = 4;
    std::uint8_t const* const first = from.first + twice_pitch / 4 * from.stride;
    int sum = 0;
    for (std::size_t y = 0; y < framelet_side && sum <= most;) {
        Sums sums{};
        for (std::size_t i = 0; i < rows_at_a_time; ++i, y += apart) {
            sums += differences(rows[y], row_at(first + y * twice_pitch / 2 * from.stride));
        }
        sum += static_cast<int>(sums[0] + sums[1]);
    }
    return sum;
}

int difference(Rows const& rows, SearchPicture::Source const& from, std::size_t apart, int most) {
    switch (from.pitch) {
    case 0:
        return difference(rows, from, apart, most, 1, doubled_row_at);
    case 1:
        return difference(rows, from, apart, most, 2, row_at<std::uint8_t>);
    case 2:
        return difference(rows, from, apart, most, 4, row_at<std::uint16_t>);
    case 4:
        return difference(rows, from, apart, most, 8, row_at<std::uint32_t>);
    case 8:
        return difference(rows, from, apart, most, 16, row_at<std::uint64_t>);
    default:
        return difference(rows, from, apart, most, 32, coarsest_row_at);
    }
}

} // namespace

PictureVector VectorSearch::find(HeldPicture const& held, DisplayFramelet const& framelet) {
    if (!held.is_searched()) {
        return {};
    }
    Rows const rows = rows_of(framelet.green);
    HeldPicture::Place const place = held.place(framelet.tile);
    std::size_t apart = 2;
    int least = std::numeric_limits<int>::max();
    auto const cost = [&](PictureVector vector) {
        int const of_length = length_cost * (std::abs(int{vector.x}) + std::abs(int{vector.y}));
        int const by = static_cast<int>(apart);
        return by * difference(rows, held.searched(place, vector), apart, (least - of_length) / by) + of_length;
    };
    PictureVector best;
    least = cost(best);
    auto const try_one = [&](int x, int y) {
        PictureVector const vector{static_cast<std::int8_t>(std::clamp(x, -farthest, farthest)),
                                   static_cast<std::int8_t>(std::clamp(y, -farthest, farthest))};
        if (int const there = cost(vector); there < least) {
            least = there;
            best = vector;
        }
    };
    for (PictureVector const vector : found_) {
        try_one(vector.x, vector.y);
    }
    for (int step = least <= hardly_any ? near_step : first_step; step > 0; step /= 2) {
        if (step == exact_step) {
            apart = 1;
            least = std::numeric_limits<int>::max();
            least = cost(best);
        }
        PictureVector const centre = best;
        for (int y = -step; y <= step; y += step) {
            for (int x = -step; x <= step; x += step) {
                if (x != 0 || y != 0) {
                    try_one(centre.x + x, centre.y + y);
                }
            }
        }
    }
    if (std::find(found_.begin(), found_.end(), best) == found_.end()) {
        found_[next_] = best;
        next_ = (next_ + 1) % found_.size();
    }
    return best;
}

} // namespace framelet
