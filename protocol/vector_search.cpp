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
/// What a vector must gain for each half pixel that it is longer: of two that are as good, the shorter one.
constexpr int length_cost = 4;

/// Sum of differences of rows `apart` from each other. `Lane` holds a row of the values that a sample covers.
template <typename Lane>
int difference_of(SamplePlane const& rows, HeldPicture::Source const& from, std::size_t apart) {
    constexpr std::size_t pitch = sizeof(Lane);
    int sum = 0;
    for (std::size_t y = 0; y < framelet_side; y += apart) {
        std::uint8_t const* const held = from.first + (y * pitch + pitch / 2) * from.stride;
        for (std::size_t x = 0; x < framelet_side; ++x) { // many at a time
            Lane values;
            std::memcpy(&values, held + x * pitch, pitch);
            sum += std::abs(int{rows[y * framelet_side + x]} - static_cast<int>(values >> (8 * (pitch / 2)) & 255));
        }
    }
    return sum;
}

/// The same of every second sample.
int difference_of_coarsest(SamplePlane const& rows, HeldPicture::Source const& from, std::size_t apart) {
    constexpr std::size_t pitch = 16;
    int sum = 0;
    for (std::size_t y = 0; y < framelet_side; y += apart) {
        std::uint8_t const* const held = from.first + (y * pitch + pitch / 2) * from.stride + pitch / 2;
        for (std::size_t x = y / apart % 2; x < framelet_side; x += 2) {
            sum += std::abs(int{rows[y * framelet_side + x]} - int{held[x * pitch]});
        }
    }
    return 2 * sum;
}

int difference_of_finest(SamplePlane const& rows, HeldPicture::Source const& from, std::size_t apart) {
    int sum = 0;
    for (std::size_t y = 0; y < framelet_side; y += apart) {
        std::uint8_t const* const held = from.first + (y / 2) * from.stride;
        for (std::size_t x = 0; x < framelet_side; ++x) {
            sum += std::abs(int{rows[y * framelet_side + x]} - int{held[x / 2]});
        }
    }
    return sum;
}

int difference(SamplePlane const& rows, HeldPicture::Source const& from, std::size_t apart) {
    switch (from.pitch) {
    case 0:
        return difference_of_finest(rows, from, apart);
    case 1:
        return difference_of<std::uint8_t>(rows, from, apart);
    case 2:
        return difference_of<std::uint16_t>(rows, from, apart);
    case 4:
        return difference_of<std::uint32_t>(rows, from, apart);
    case 8:
        return difference_of<std::uint64_t>(rows, from, apart);
    default:
        return difference_of_coarsest(rows, from, apart);
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
    for (int step = first_step; step > 0; step /= 2) {
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
