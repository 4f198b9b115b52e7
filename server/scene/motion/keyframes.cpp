#include "server/scene/motion/keyframes.h"

#include <algorithm>

#include "server/scene/vector_math.h"

namespace framelet {
namespace {

Quat load_quaternion(float const* xyzw) {
    return unit_rotation(Quat(xyzw[3], xyzw[0], xyzw[1], xyzw[2]));
}

void store_quaternion(Quat const& q, std::span<float> out) {
    out[0] = q.x;
    out[1] = q.y;
    out[2] = q.z;
    out[3] = q.w;
}

/// Cubic Hermite spline with the file's tangents; `t` 0..1 between keys that are `seconds` apart.
void interpolate_spline(float const* from, float const* to, float t, float seconds, std::span<float> out) {
    std::size_t const n = out.size();
    float const t2 = t * t;
    float const t3 = t2 * t;
    for (std::size_t c = 0; c < n; ++c) {
        float const value0 = from[n + c];
        float const out_tangent = seconds * from[2 * n + c];
        float const in_tangent = seconds * to[c];
        float const value1 = to[n + c];
        out[c] = (2 * t3 - 3 * t2 + 1) * value0 + (t3 - 2 * t2 + t) * out_tangent + (3 * t2 - 2 * t3) * value1 +
                 (t3 - t2) * in_tangent;
    }
}

} // namespace

void sample_channel(AnimationChannel const& channel, float seconds, std::span<float> out) {
    auto const& times = channel.times;
    bool const spline = channel.interpolation == Interpolation::cubic_spline;
    std::size_t const n = out.size();
    std::size_t const width = spline ? 3 * n : n;
    auto const next = std::upper_bound(times.begin(), times.end(), seconds);
    auto const key = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - times.begin() - 1, 0));
    float const* const from = &channel.values[key * width];
    bool const rotation = channel.property == AnimatedProperty::rotation;

    if (channel.interpolation == Interpolation::step || key + 1 == times.size() || seconds <= times[key]) {
        std::copy_n(from + (spline ? n : 0), n, out.begin());
    } else {
        float const* const to = from + width;
        float const interval = times[key + 1] - times[key];
        float const t = (seconds - times[key]) / interval;
        if (!spline && std::equal(from, to, to)) { // what rests must rest to the last bit
            std::copy_n(from, n, out.begin());
        } else if (spline) {
            interpolate_spline(from, to, t, interval, out);
        } else if (rotation) {
            store_quaternion(glm::slerp(load_quaternion(from), load_quaternion(to), t), out);
        } else {
            for (std::size_t c = 0; c < n; ++c) {
                out[c] = from[c] + (to[c] - from[c]) * t;
            }
        }
    }
    if (rotation) {
        store_quaternion(load_quaternion(out.data()), out);
    }
}

} // namespace framelet
