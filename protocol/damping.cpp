#include "protocol/damping.h"

#include <algorithm>
#include <span>

#include "protocol/haar_transform.h"

namespace framelet {
namespace {

void weaken(std::span<std::int16_t> fours, Details details) {
    if (details == Details::halved) {
        std::ranges::transform(fours, fours.begin(), [](std::int16_t x) { return static_cast<std::int16_t>(x >> 1); });
    } else if (details == Details::none) {
        std::ranges::fill(fours, std::int16_t{0});
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
        weaken(plane, damping.of[0]);
        if (damping.of[1] != Details::whole) {
            std::array<std::int16_t, second> means_of_means;
            haar_forward(means.data(), means_of_means.data(), second);
            weaken(means, damping.of[1]);
            haar_inverse(means_of_means.data(), means.data(), second);
        }
        haar_inverse(means.data(), plane.data(), finest);
    }
}

} // namespace framelet
