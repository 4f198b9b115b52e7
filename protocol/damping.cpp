#include "protocol/damping.h"

#include <algorithm>

#include "protocol/haar_transform.h"

namespace framelet {
namespace {

void weaken(std::int16_t* fours, std::size_t count, Details details) {
    int const shift = details == Details::halved ? 1 : 15;
    std::int16_t const mask = details == Details::none ? 0 : -1;
    for (std::size_t i = 0; i < count && details != Details::whole; ++i) {
        fours[i] = static_cast<std::int16_t>((fours[i] >> shift) & mask);
    }
}

} // namespace

void damp(DisplayValues& values, Damping damping) {
    if (damping == Damping{}) {
        return;
    }
    constexpr std::size_t finest = HaarNumbers::places(0), second = HaarNumbers::places(1);
    for (auto& plane : values.planes) {
        std::array<std::int16_t, finest> means;
        haar_forward(plane.data(), means.data(), finest);
        weaken(plane.data(), plane.size(), damping.of[0]);
        if (damping.of[1] != Details::whole) {
            std::array<std::int16_t, second> means_of_means;
            haar_forward(means.data(), means_of_means.data(), second);
            weaken(means.data(), means.size(), damping.of[1]);
            haar_inverse(means_of_means.data(), means.data(), second);
        }
        haar_inverse(means.data(), plane.data(), finest);
    }
}

void damp(HaarValues& values, std::size_t octave, Details details) {
    for (auto& plane : values.details) {
        weaken(&plane[HaarNumbers::first_four[octave]], 4 * HaarNumbers::places(octave), details);
    }
}

} // namespace framelet
