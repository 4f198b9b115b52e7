// Gives pictures that were shown when they were ready their places in a video of constant rate. In: times. Out: how
// often the picture before is repeated, and whether a place is left for the new one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace framelet {

/// Pictures a second, as a fraction in its lowest terms.
struct PictureRate {
    int pictures = 1;
    int seconds = 1;

    /// The nearest rate of whole thousandths of a picture a second. `rate`: 0.1 to 1000.
    static PictureRate of(double rate) {
        int const thousandths = static_cast<int>(std::lround(rate * 1000));
        int const divisor = std::gcd(thousandths, 1000);
        return {thousandths / divisor, 1000 / divisor};
    }
    double per_second() const { return static_cast<double>(pictures) / seconds; }
    bool operator==(PictureRate const&) const = default;
};

class VideoClock {
public:
    explicit VideoClock(PictureRate rate) : rate_(rate.per_second()) {}

    struct Places {
        std::uint64_t before; ///< so many repeat the picture shown until now
        bool own; ///< there is one for the new picture
        bool operator==(Places const&) const = default;
    };

    /// The places of a picture that is shown from `seconds` on. It gets the one nearest to that, so that being shown a
    /// little early or late changes nothing. Time does not go back.
    Places show(double seconds) {
        auto const place = static_cast<std::uint64_t>(std::llround(std::max(seconds, 0.0) * rate_));
        if (place < next_) {
            return {0, false};
        }
        return {place - std::exchange(next_, place + 1), true};
    }

private:
    double rate_;
    std::uint64_t next_ = 0;
};

} // namespace framelet
