// Implements structural similarity.
#include <array>
#include <cmath>

#include "common/error.h"
#include "tests/evaluation/measures/filter.h"
#include "tests/evaluation/measures/measures.h"

namespace framelet::bench {
namespace {

constexpr int window = 11;
constexpr double sigma = 1.5;
constexpr double c1 = (0.01 * 255) * (0.01 * 255);
constexpr double c2 = (0.03 * 255) * (0.03 * 255);

/// Luma rounded to a byte, as in the grey pictures that the measure is defined on.
Plane luma_of(Picture const& picture) {
    Plane plane(picture.width, picture.height);
    for (std::size_t i = 0; i < plane.values.size(); ++i) {
        std::uint8_t const* const p = &picture.rgba[4 * i];
        plane.values[i] = static_cast<float>((77 * p[0] + 150 * p[1] + 29 * p[2] + 128) / 256);
    }
    return plane;
}

Plane product(Plane const& a, Plane const& b) {
    Plane plane(a.width, a.height);
    for (std::size_t i = 0; i < plane.values.size(); ++i) {
        plane.values[i] = a.values[i] * b.values[i];
    }
    return plane;
}

double similarity(double mean_a, double mean_b, double square_a, double square_b, double mixed) {
    double const variances = square_a - mean_a * mean_a + square_b - mean_b * mean_b;
    double const covariance = mixed - mean_a * mean_b;
    return (2 * mean_a * mean_b + c1) * (2 * covariance + c2) /
           ((mean_a * mean_a + mean_b * mean_b + c1) * (variances + c2));
}

double mean_of(Plane const& plane) {
    double sum = 0;
    for (float const value : plane.values) {
        sum += value;
    }
    return sum / static_cast<double>(plane.values.size());
}

} // namespace

double structural_similarity(Picture const& shown, Picture const& reference) {
    FRAMELET_CHECK(shown.width == reference.width && shown.height == reference.height && !reference.rgba.empty());
    Plane const a = luma_of(shown);
    Plane const b = luma_of(reference);
    Plane const aa = product(a, a);
    Plane const bb = product(b, b);
    Plane const ab = product(a, b);
    if (a.width < window || a.height < window) {
        return similarity(mean_of(a), mean_of(b), mean_of(aa), mean_of(bb), mean_of(ab));
    }
    std::array<float, window> kernel{};
    double sum = 0;
    for (int i = 0; i < window; ++i) {
        double const x = i - window / 2;
        kernel[static_cast<std::size_t>(i)] = static_cast<float>(std::exp(-x * x / (2 * sigma * sigma)));
        sum += kernel[static_cast<std::size_t>(i)];
    }
    for (float& weight : kernel) {
        weight = static_cast<float>(weight / sum);
    }
    Plane const mean_a = filter(a, kernel, kernel);
    Plane const mean_b = filter(b, kernel, kernel);
    Plane const square_a = filter(aa, kernel, kernel);
    Plane const square_b = filter(bb, kernel, kernel);
    Plane const mixed = filter(ab, kernel, kernel);
    double total = 0;
    constexpr int margin = window / 2;
    for (int y = margin; y < a.height - margin; ++y) {
        for (int x = margin; x < a.width - margin; ++x) {
            std::size_t const i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(x);
            total +=
                similarity(mean_a.values[i], mean_b.values[i], square_a.values[i], square_b.values[i], mixed.values[i]);
        }
    }
    return total / (static_cast<double>(a.width - 2 * margin) * (a.height - 2 * margin));
}

} // namespace framelet::bench
