#include "server/sampling/plan/render_rate.h"

#include <cmath>

namespace framelet {

RenderRate update_render_rate(RenderRate rate, double samples, double seconds) {
    if (!(seconds > 0) || !(samples > 0)) {
        return rate;
    }
    constexpr double memory_seconds = 0.25;
    double const measured = samples / seconds;
    if (rate.samples_per_second <= 0) {
        return {measured};
    }
    // Averages time per sample, not samples per time, so that one lucky small batch does not promise too much.
    double const weight = 1 - std::exp(-seconds / memory_seconds);
    return {1 / ((1 - weight) / rate.samples_per_second + weight / measured)};
}

} // namespace framelet
