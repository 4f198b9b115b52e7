#include "server/render/path/sky_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/render/light/environment_filter.h"

namespace framelet {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr int width = 512, height = 256; // 0.7 degrees: about a sun's diameter
/// Share of the samples that goes everywhere alike, also where the filtered map is black.
constexpr float even_share = 0.02f;

/// Solid angle of each texel of a row.
float texel_angle(int y) {
    float const top = std::cos(pi * static_cast<float>(y) / height);
    float const bottom = std::cos(pi * static_cast<float>(y + 1) / height);
    return 2 * pi / width * (top - bottom);
}

/// Finds the step of the sums in which `random` lies, and where in it.
int find_step(float const* sums, int count, float& random) {
    int const found = std::min(static_cast<int>(std::upper_bound(sums, sums + count, random) - sums), count - 1);
    float const before = found > 0 ? sums[found - 1] : 0.0f;
    random = std::clamp((random - before) / std::max(sums[found] - before, 1e-30f), 0.0f, 0.9999999f);
    return found;
}

float share_of(float const* sums, int i) {
    return sums[i] - (i > 0 ? sums[i - 1] : 0.0f);
}

} // namespace

SkyTable::SkyTable(Environment const& environment) {
    FloatImage const directions(width, height);
    std::vector<double> weights;
    double total = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            Vec3 const value = environment.background(direction_of_texel(directions, x, y), 2 * pi / width);
            weights.push_back(double((value.r + value.g + value.b) * texel_angle(y)));
            total += weights.back();
        }
    }
    if (!(total > 0)) {
        return;
    }
    double all_rows = 0;
    for (int y = 0; y < height; ++y) {
        double const even = double(even_share * texel_angle(y) / (4 * pi)) * total;
        double row = 0;
        for (int x = 0; x < width; ++x) {
            row += weights[static_cast<std::size_t>(y * width + x)] + even;
        }
        double sum = 0;
        for (int x = 0; x < width; ++x) {
            sum += weights[static_cast<std::size_t>(y * width + x)] + even;
            columns_.push_back(static_cast<float>(sum / row));
        }
        all_rows += row;
        rows_.push_back(static_cast<float>(all_rows / (total * double(1 + even_share))));
    }
}

Vec3 SkyTable::sample(Vec2 random) const {
    int const y = find_step(rows_.data(), height, random.y);
    int const x = find_step(columns_.data() + static_cast<std::ptrdiff_t>(y) * width, width, random.x);
    // Within a texel evenly by solid angle.
    float const top = std::cos(pi * static_cast<float>(y) / height);
    float const bottom = std::cos(pi * static_cast<float>(y + 1) / height);
    float const v = std::acos(std::clamp(top + (bottom - top) * random.y, -1.0f, 1.0f)) / pi;
    return direction_from_equirect({(static_cast<float>(x) + random.x) / width, v});
}

float SkyTable::density(Vec3 const& direction) const {
    Vec2 const point = equirect_from_direction(direction);
    int const x = std::clamp(static_cast<int>(point.x * width), 0, width - 1);
    int const y = std::clamp(static_cast<int>(point.y * height), 0, height - 1);
    return share_of(rows_.data(), y) * share_of(columns_.data() + static_cast<std::ptrdiff_t>(y) * width, x) /
           texel_angle(y);
}

} // namespace framelet
