#include "protocol/vector_search.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "protocol/morton_rows.h"

namespace framelet {
namespace {

/// First steps of the search, half pixels, and those from which on all rows are looked at, not every second one.
constexpr int first_step = 32, exact_step = 2;
constexpr int farthest = 127;
/// Sum of differences of what is found already: the quantiser would leave nothing of them.
constexpr int hardly_any = 2 * framelet_samples;
/// What a vector must gain for each half pixel that it is longer: of two that are as good, the shorter one.
constexpr int length_cost = 4;

using Row = std::array<std::uint8_t, framelet_side>;

/// Values of a row of samples, one of each: `held` is where the first of them is. `Lane` holds as many as a sample
/// covers.
template <typename Lane>
void fetch_points(std::uint8_t const* held, std::size_t /*stride*/, Row& row) {
    constexpr std::size_t pitch = sizeof(Lane);
    for (std::size_t x = 0; x < row.size(); ++x) { // many at a time
        Lane values;
        std::memcpy(&values, held + x * pitch, pitch);
        row[x] = static_cast<std::uint8_t>(values >> (8 * (pitch / 2)));
    }
}

/// Predicted samples of a row: `held` is where the values are that it is compared with, their rows `stride` apart.
/// `Lane` holds as many as a sample covers.
template <typename Lane>
void fetch_means(std::uint8_t const* held, std::size_t stride, Row& row) {
    constexpr std::size_t pitch = sizeof(Lane);
    constexpr unsigned left = 8 * (pitch / 2 - 1), right = left + 8;
    for (std::size_t x = 0; x < row.size(); ++x) { // many at a time
        Lane above, below;
        std::memcpy(&above, held + x * pitch, pitch);
        std::memcpy(&below, held + stride + x * pitch, pitch);
        auto const sum = static_cast<std::uint16_t>((above >> left & 255) + (above >> right & 255) +
                                                    (below >> left & 255) + (below >> right & 255));
        row[x] = static_cast<std::uint8_t>((sum + 2) >> 2);
    }
}

void fetch_coarsest(std::uint8_t const* held, std::size_t /*stride*/, Row& row) {
    constexpr std::size_t pitch = 16;
    for (std::size_t x = 0; x < row.size(); ++x) {
        row[x] = held[x * pitch + pitch / 2];
    }
}

void fetch_each(std::uint8_t const* held, std::size_t /*stride*/, Row& row) {
    std::memcpy(row.data(), held, row.size());
}

void fetch_doubled(std::uint8_t const* held, std::size_t /*stride*/, Row& row) {
    for (std::size_t x = 0; x < row.size(); ++x) {
        row[x] = held[x / 2];
    }
}

/// Sum of differences of rows `apart` from each other. `first`: the first row of values that is looked at;
/// `twice_pitch` of them belong to two rows of samples.
template <typename Fetch>
int difference(SamplePlane const& rows, HeldPicture::Source const& from, std::size_t apart, std::size_t first,
               std::size_t twice_pitch, Fetch const& fetch) {
    int sum = 0;
    for (std::size_t y = 0; y < framelet_side; y += apart) {
        Row row;
        fetch(from.first + (first + y * twice_pitch / 2) * from.stride, from.stride, row);
        for (std::size_t x = 0; x < row.size(); ++x) {
            sum += std::abs(int{rows[y * framelet_side + x]} - int{row[x]});
        }
    }
    return sum;
}

/// Of all rows what will be predicted, or of every second one what is near that.
int difference(SamplePlane const& rows, HeldPicture::Source const& from, std::size_t apart) {
    bool const is_exact = apart == 1;
    switch (from.pitch) {
    case 0:
        return difference(rows, from, apart, 0, 1, fetch_doubled);
    case 1:
        return difference(rows, from, apart, 0, 2, fetch_each);
    case 2:
        return is_exact ? difference(rows, from, apart, 0, 4, fetch_means<std::uint16_t>)
                        : difference(rows, from, apart, 1, 4, fetch_points<std::uint16_t>);
    case 4:
        return is_exact ? difference(rows, from, apart, 1, 8, fetch_means<std::uint32_t>)
                        : difference(rows, from, apart, 2, 8, fetch_points<std::uint32_t>);
    case 8:
        return is_exact ? difference(rows, from, apart, 3, 16, fetch_means<std::uint64_t>)
                        : difference(rows, from, apart, 4, 16, fetch_points<std::uint64_t>);
    default:
        return difference(rows, from, apart, 8, 32, fetch_coarsest);
    }
}

} // namespace

PictureVector VectorSearch::find(HeldPicture const& held, DisplayFramelet const& framelet) {
    constexpr std::size_t green = 1;
    SamplePlane rows;
    to_rows(framelet.green.data(), rows.data(), framelet_side);
    std::size_t apart = 2;
    auto const cost = [&](PictureVector vector) {
        return static_cast<int>(apart) * difference(rows, held.source(framelet.tile, vector, green), apart) +
               length_cost * (std::abs(int{vector.x}) + std::abs(int{vector.y}));
    };
    PictureVector best;
    int least = cost(best);
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
    for (int step = least <= hardly_any ? exact_step : first_step; step > 0; step /= 2) {
        if (step == exact_step) {
            apart = 1;
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
