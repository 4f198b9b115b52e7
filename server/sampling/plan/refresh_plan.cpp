#include "server/sampling/plan/refresh_plan.h"

#include <algorithm>

namespace framelet {

float cycle_length(bool still, double plan_seconds) {
    return still ? most_cycle_seconds
                 : std::clamp(static_cast<float>(40 * plan_seconds), least_cycle_seconds, most_cycle_seconds);
}

double rays_a_sample(RefreshInput const& input) {
    return std::max(input.rendered_per_second / input.samples_per_second, 1.0);
}

std::size_t batch_limit(RefreshInput const& input, bool still) {
    if (input.batch_framelets > 0) {
        return std::min({input.batch_framelets, input.link_framelets, max_batch_framelets});
    }
    double const share = still ? 2 : 0.5; // half a cycle shows sooner
    double const timely =
        share * input.samples_per_second * static_cast<double>(input.cycle_seconds) / framelet_samples;
    std::size_t const most = std::min(input.link_framelets, max_batch_framelets);
    double const least = static_cast<double>(std::min(input.least_framelets, most));
    return static_cast<std::size_t>(std::clamp(timely, least, static_cast<double>(most)));
}

} // namespace framelet
