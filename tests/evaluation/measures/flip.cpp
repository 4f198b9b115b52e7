// LDR-FLIP: colours filtered by what the eye resolves, compared by HyAB distance, weighed by differences of edges and
// points. Section numbers are those of [Andersson 2020].
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/color.h"
#include "common/error.h"
#include "tests/evaluation/measures/filter.h"
#include "tests/evaluation/measures/measures.h"

namespace framelet::bench {
namespace {

constexpr double pi = std::numbers::pi;

/// One Gaussian of a contrast sensitivity function: a sqrt(pi / b) exp(-pi^2 d^2 / b), d in degrees (table 1).
struct Gaussian {
    double a, b;
};
constexpr Gaussian achromatic{1, 0.0047}, red_green{1, 0.0053}, blue_yellow_narrow{34.1, 0.04},
    blue_yellow_wide{13.5, 0.025};

constexpr double hyab_exponent = 0.7;
constexpr double knee_in = 0.4, knee_out = 0.95; ///< knee of the compression of colour differences (4.1.4)
constexpr double feature_width = 0.082; ///< width of the feature filters, degrees (4.2)

using Color = std::array<double, 3>;

/// CIE XYZ (D65, divided by white) of linear sRGB.
Color xyz_from_linear(Color const& c) {
    return {(10135552.0 * c[0] + 8788810.0 * c[1] + 4435075.0 * c[2]) / 24577794.0 / 0.950428545,
            (2613072.0 * c[0] + 8788810.0 * c[1] + 887015.0 * c[2]) / 12288897.0,
            (1425312.0 * c[0] + 8788810.0 * c[1] + 70074185.0 * c[2]) / 73733382.0 / 1.088900371};
}

Color linear_from_xyz(Color const& n) {
    double const x = n[0] * 0.950428545, y = n[1], z = n[2] * 1.088900371;
    return {3.241003232976359 * x - 1.537398969488785 * y - 0.498615881996363 * z,
            -0.969224252202517 * x + 1.875929983695176 * y + 0.041554226340085 * z,
            0.055639419851975 * x - 0.204011206123910 * y + 1.057148977187533 * z};
}

/// Colour in YCxCz, in which the eye's filters are applied.
Color opponent_from_xyz(Color const& n) {
    return {116 * n[1] - 16, 500 * (n[0] - n[1]), 200 * (n[1] - n[2])};
}

Color xyz_from_opponent(Color const& o) {
    double const y = (o[0] + 16) / 116;
    return {y + o[1] / 500, y, y - o[2] / 200};
}

/// Colour in CIELAB with the Hunt effect: colours fade with lightness (4.1.3).
Color hunt_lab(Color const& linear) {
    Color n = xyz_from_linear(linear);
    for (double& v : n) {
        constexpr double delta = 6.0 / 29;
        v = v > delta * delta * delta ? std::cbrt(v) : v / (3 * delta * delta) + 4.0 / 29;
    }
    double const lightness = 116 * n[1] - 16;
    return {lightness, 0.01 * lightness * 500 * (n[0] - n[1]), 0.01 * lightness * 200 * (n[1] - n[2])};
}

double color_distance(Color const& a, Color const& b) {
    return std::pow(std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]), hyab_exponent);
}

/// Taps of one axis of a separable Gaussian, not normalised.
std::vector<float> gaussian_taps(double b, double pixels_per_degree, int radius) {
    std::vector<float> taps;
    for (int i = -radius; i <= radius; ++i) {
        double const degrees = i / pixels_per_degree;
        taps.push_back(static_cast<float>(std::exp(-pi * pi * degrees * degrees / b)));
    }
    return taps;
}

double sum_of(std::vector<float> const& taps) {
    double sum = 0;
    for (float const tap : taps) {
        sum += tap;
    }
    return sum;
}

/// Filters a channel by a sum of Gaussians that is normalised as a whole.
Plane filter_channel(Plane const& plane, std::initializer_list<Gaussian> gaussians, double pixels_per_degree) {
    int const radius =
        static_cast<int>(std::ceil(3 * std::sqrt(blue_yellow_narrow.b / (2 * pi * pi)) * pixels_per_degree));
    Plane result(plane.width, plane.height);
    double total = 0;
    for (Gaussian const& g : gaussians) {
        auto const taps = gaussian_taps(g.b, pixels_per_degree, radius);
        double const weight = g.a * std::sqrt(pi / g.b);
        total += weight * sum_of(taps) * sum_of(taps);
        Plane const filtered = filter(plane, taps, taps);
        for (std::size_t i = 0; i < result.values.size(); ++i) {
            result.values[i] += static_cast<float>(weight) * filtered.values[i];
        }
    }
    for (float& value : result.values) {
        value = static_cast<float>(value / total);
    }
    return result;
}

struct FeaturePlanes {
    Plane edges, points;
};

/// Scales the taps so that the positive ones add up to 1 and the negative ones to -1.
void balance(std::vector<float>& taps) {
    double positive = 0, negative = 0;
    for (float const tap : taps) {
        (tap > 0 ? positive : negative) += std::abs(tap);
    }
    for (float& tap : taps) {
        tap = static_cast<float>(tap / (tap > 0 ? positive : negative));
    }
}

Plane magnitude(Plane const& plane, std::vector<float> const& derivative, std::vector<float> const& smooth) {
    Plane across = filter(plane, derivative, smooth);
    Plane const down = filter(plane, smooth, derivative);
    for (std::size_t i = 0; i < across.values.size(); ++i) {
        across.values[i] = std::hypot(across.values[i], down.values[i]);
    }
    return across;
}

FeaturePlanes features_of(Plane const& lightness, double pixels_per_degree) {
    double const deviation = 0.5 * feature_width * pixels_per_degree;
    int const radius = static_cast<int>(std::ceil(3 * deviation));
    std::vector<float> smooth, first, second;
    for (int i = -radius; i <= radius; ++i) {
        double const g = std::exp(-i * i / (2 * deviation * deviation));
        smooth.push_back(static_cast<float>(g));
        first.push_back(static_cast<float>(-i * g));
        second.push_back(static_cast<float>((i * i / (deviation * deviation) - 1) * g));
    }
    double const sum = sum_of(smooth);
    for (float& tap : smooth) {
        tap = static_cast<float>(tap / sum);
    }
    balance(first);
    balance(second);
    return {magnitude(lightness, first, smooth), magnitude(lightness, second, smooth)};
}

/// A picture as the eye perceives it.
struct Perceived {
    std::vector<Color> lab;
    FeaturePlanes features;
};

Perceived perceive(Picture const& picture, double pixels_per_degree) {
    std::size_t const count = picture.rgba.size() / 4;
    std::array<Plane, 3> opponent{Plane(picture.width, picture.height), Plane(picture.width, picture.height),
                                  Plane(picture.width, picture.height)};
    Plane lightness(picture.width, picture.height);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint8_t const* const p = &picture.rgba[4 * i];
        Color const o = opponent_from_xyz(
            xyz_from_linear({linear_from_srgb_byte(p[0]), linear_from_srgb_byte(p[1]), linear_from_srgb_byte(p[2])}));
        for (std::size_t c = 0; c < 3; ++c) {
            opponent[c].values[i] = static_cast<float>(o[c]);
        }
        lightness.values[i] = static_cast<float>((o[0] + 16) / 116);
    }
    Plane const y = filter_channel(opponent[0], {achromatic}, pixels_per_degree);
    Plane const cx = filter_channel(opponent[1], {red_green}, pixels_per_degree);
    Plane const cz = filter_channel(opponent[2], {blue_yellow_narrow, blue_yellow_wide}, pixels_per_degree);
    Perceived perceived{std::vector<Color>(count), features_of(lightness, pixels_per_degree)};
    for (std::size_t i = 0; i < count; ++i) {
        Color linear = linear_from_xyz(xyz_from_opponent({y.values[i], cx.values[i], cz.values[i]}));
        for (double& v : linear) {
            v = std::clamp(v, 0.0, 1.0);
        }
        perceived.lab[i] = hunt_lab(linear);
    }
    return perceived;
}

} // namespace

double mean_flip(Picture const& shown, Picture const& reference, double pixels_per_degree) {
    FRAMELET_CHECK(shown.width == reference.width && shown.height == reference.height && !reference.rgba.empty());
    Perceived const a = perceive(shown, pixels_per_degree);
    Perceived const b = perceive(reference, pixels_per_degree);
    double const largest = color_distance(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1}));
    double const knee = knee_in * largest;
    double sum = 0;
    for (std::size_t i = 0; i < a.lab.size(); ++i) {
        double const distance = color_distance(a.lab[i], b.lab[i]);
        double const color = distance < knee ? distance * knee_out / knee
                                             : knee_out + (distance - knee) / (largest - knee) * (1 - knee_out);
        double const edges = std::abs(a.features.edges.values[i] - b.features.edges.values[i]);
        double const points = std::abs(a.features.points.values[i] - b.features.points.values[i]);
        double const feature = std::sqrt(std::max(edges, points) / std::numbers::sqrt2);
        sum += std::pow(std::min(color, 1.0), 1 - std::min(feature, 1.0));
    }
    return sum / static_cast<double>(a.lab.size());
}

} // namespace framelet::bench
