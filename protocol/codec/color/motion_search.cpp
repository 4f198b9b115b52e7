#include "protocol/codec/color/motion_search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "protocol/codec/entropy/morton_rows.h"

namespace framelet {
namespace {

/// First and largest step of a search, half pixels.
constexpr int first_step = 16;
/// Sum of differences of a framelet, 8 a sample: where a vector that was found before leaves no more than this, the
/// search begins near it, with steps of `near_step` half pixels.
constexpr int hardly_any = 2048, near_step = 4;
constexpr int farthest = 127;
/// Cost of each half pixel of a vector's length, in the unit of the sum of differences: of two vectors that are as good
/// the shorter one is taken.
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
Row row_at(std::uint8_t const* points) {
    constexpr std::size_t pitch = sizeof(Lane);
    using Lanes [[gnu::vector_size(framelet_side * pitch)]] = Lane;
    Lanes values;
    std::memcpy(&values, points, sizeof values);
    return __builtin_convertvector(values >> (8 * (pitch / 2)), Row);
}

Row doubled_row_at(std::uint8_t const* points) {
    using Half [[gnu::vector_size(framelet_side / 2)]] = std::uint8_t;
    Half half;
    std::memcpy(&half, points, sizeof half);
    return __builtin_shufflevector(half, half, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7);
}

using Sums [[gnu::vector_size(framelet_side)]] = std::uint64_t;

/// Sums of the absolute differences in each half of a row.
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

/// Layout of a framelet's samples in the picture: `twice_pitch` rows of it are two rows of samples.
template <std::size_t twice, Row (*at)(std::uint8_t const*)>
struct Reading {
    static constexpr std::size_t twice_pitch = twice;
    static Row row_at(std::uint8_t const* points) { return at(points); }
};

/// Sum of absolute differences of rows `apart` from each other, or any number above `most` where it is above that.
template <typename Reading, std::size_t apart>
int difference(Rows const& rows, SearchPicture::Source const& from, int most) {
    constexpr std::size_t rows_at_a_time = 4;
    std::uint8_t const* const first = from.first + Reading::twice_pitch / 4 * from.stride;
    int sum = 0;
    for (std::size_t y = 0; y < framelet_side && sum <= most;) {
        Sums sums{};
        for (std::size_t i = 0; i < rows_at_a_time; ++i, y += apart) {
            sums += differences(rows[y], Reading::row_at(first + y * Reading::twice_pitch / 2 * from.stride));
        }
        sum += static_cast<int>(sums[0] + sums[1]);
    }
    return sum;
}

/// The search for one framelet.
template <typename Reading>
class Search {
public:
    Search(ReferencePicture const& reference, Rows const& rows, ReferencePicture::Square const& square)
        : reference_(reference), rows_(rows), square_(square) {}

    MotionVector best() const { return best_; }
    bool leaves_hardly_any() const { return least_ <= hardly_any; }

    /// Compares only rows `apart` from each other from now on: begins anew with the best vector so far.
    template <std::size_t apart>
    void compare_rows() {
        least_ = std::numeric_limits<int>::max();
        least_ = cost<apart>(best_);
    }

    template <std::size_t apart>
    void consider(int x, int y) {
        MotionVector const vector{static_cast<std::int8_t>(std::clamp(x, -farthest, farthest)),
                                  static_cast<std::int8_t>(std::clamp(y, -farthest, farthest))};
        if (int const there = cost<apart>(vector); there < least_) {
            least_ = there;
            best_ = vector;
        }
    }

    template <std::size_t apart>
    void consider_around(int step) {
        MotionVector const centre = best_;
        for (int y = -step; y <= step; y += step) {
            for (int x = -step; x <= step; x += step) {
                if (x != 0 || y != 0) {
                    consider<apart>(centre.x + x, centre.y + y);
                }
            }
        }
    }

private:
    template <std::size_t apart>
    int cost(MotionVector vector) const {
        int const of_length = length_cost * (std::abs(int{vector.x}) + std::abs(int{vector.y}));
        constexpr int by = static_cast<int>(apart);
        return by * difference<Reading, apart>(rows_, reference_.searched(square_, vector), (least_ - of_length) / by) +
               of_length;
    }

    ReferencePicture const& reference_;
    Rows const& rows_;
    ReferencePicture::Square const square_;
    MotionVector best_;
    int least_ = std::numeric_limits<int>::max();
};

/// Tries the vectors found before, then steps from the best one down to `last_step`, half pixels.
template <typename Reading, std::size_t apart>
void search_in_steps(Search<Reading>& search, std::span<MotionVector const> found, int last_step) {
    search.template compare_rows<apart>();
    for (MotionVector const vector : found) {
        search.template consider<apart>(vector.x, vector.y);
    }
    for (int step = search.leaves_hardly_any() ? near_step : first_step; step >= last_step; step /= 2) {
        search.template consider_around<apart>(step);
    }
}

template <typename Reading>
MotionVector search_coarsely(ReferencePicture const& reference, Rows const& rows,
                             ReferencePicture::Square const& square, std::span<MotionVector const> found) {
    Search<Reading> search(reference, rows, square);
    search_in_steps<Reading, 2>(search, found, SearchPicture::coarse);
    return search.best();
}

template <typename Reading>
MotionVector search_finely(ReferencePicture const& reference, Rows const& rows, ReferencePicture::Square const& square,
                           std::span<MotionVector const> found) {
    Search<Reading> search(reference, rows, square);
    search_in_steps<Reading, 4>(search, found, near_step);
    search.template compare_rows<2>();
    search.template consider_around<2>(2);
    search.template compare_rows<1>();
    search.template consider_around<1>(1);
    return search.best();
}

MotionVector search(ReferencePicture const& reference, Rows const& rows, ReferencePicture::Square const& square,
                    std::span<MotionVector const> found) {
    switch (square.pitch()) {
    case -1:
        return search_finely<Reading<1, doubled_row_at>>(reference, rows, square, found);
    case 0:
        return search_finely<Reading<2, row_at<std::uint8_t>>>(reference, rows, square, found);
    case 1:
        return search_finely<Reading<4, row_at<std::uint16_t>>>(reference, rows, square, found);
    case 2:
        return search_finely<Reading<8, row_at<std::uint32_t>>>(reference, rows, square, found);
    case 3: // searched among the coarse points, as is all that is coarser
        return search_coarsely<Reading<4, row_at<std::uint16_t>>>(reference, rows, square, found);
    default:
        return search_coarsely<Reading<8, row_at<std::uint32_t>>>(reference, rows, square, found);
    }
}

} // namespace

MotionVector MotionSearch::find(ReferencePicture const& reference, DisplayFramelet const& framelet) {
    if (!reference.is_searched()) {
        return {};
    }
    MotionVector const best = search(reference, rows_of(framelet.green), reference.square(framelet.tile), found_);
    if (std::find(found_.begin(), found_.end(), best) == found_.end()) {
        found_[next_] = best;
        next_ = (next_ + 1) % found_.size();
    }
    return best;
}

} // namespace framelet
