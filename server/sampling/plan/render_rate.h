// Estimates how fast the renderer is, from what it did lately. In: samples and seconds of each batch. Out: samples per
// second.
#pragma once

namespace framelet {

/// Rate assumed of a renderer that has not been measured yet.
inline constexpr double first_samples_per_second = 1e6;

/// Running estimate; 0 until the first measurement.
struct RenderRate {
    double samples_per_second = 0;
};

/// Takes a batch into account. Short batches weigh less: the estimate follows the last quarter of a second or so.
RenderRate update_render_rate(RenderRate rate, double samples, double seconds);

} // namespace framelet
