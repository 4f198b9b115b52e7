#include "tests/evaluation/charts/spectrum.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "tests/evaluation/charts/real_dft.h"

namespace framelet::bench {
namespace {

constexpr std::size_t first_point = 2;
constexpr std::size_t least_points = 3;
constexpr double highest_frequency = 0.25;
constexpr double least_power = 1e-12;

double luma(std::uint8_t const* pixel) {
    return (0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2]) / 255;
}

double sum_of(std::vector<double> const& values) {
    double sum = 0;
    for (double const value : values) {
        sum += value;
    }
    return sum;
}

double sum_of_squares(std::vector<double> const& values) {
    double sum = 0;
    for (double const value : values) {
        sum += value * value;
    }
    return sum;
}

void fill_windowed(Picture const& picture, std::vector<double> const& columns, std::vector<double> const& rows,
                   double* signal) {
    auto const width = columns.size();
    double mean = 0;
    for (std::size_t y = 0; y < rows.size(); ++y) {
        std::uint8_t const* const row = picture.row(static_cast<int>(y));
        for (std::size_t x = 0; x < width; ++x) {
            signal[y * width + x] = luma(row + 4 * x);
            mean += rows[y] * columns[x] * signal[y * width + x];
        }
    }
    mean /= sum_of(columns) * sum_of(rows);
    for (std::size_t y = 0; y < rows.size(); ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            double& value = signal[y * width + x];
            value = (value - mean) * rows[y] * columns[x];
        }
    }
}

/// The values of one row of pixels at all times, a signal a pixel.
void fill_row(std::span<Picture const> pictures, int y, std::vector<double> const& window, double* signal) {
    auto const width = static_cast<std::size_t>(pictures[0].width);
    std::size_t const times = pictures.size();
    double const window_sum = sum_of(window);
    for (std::size_t x = 0; x < width; ++x) {
        double* const values = signal + x * times;
        double mean = 0;
        for (std::size_t t = 0; t < times; ++t) {
            values[t] = luma(pictures[t].row(y) + 4 * x);
            mean += window[t] * values[t];
        }
        mean /= window_sum;
        for (std::size_t t = 0; t < times; ++t) {
            values[t] = (values[t] - mean) * window[t];
        }
    }
}

} // namespace

std::vector<SpectrumPoint> radial_power(Picture const& picture) {
    int const width = picture.width, height = picture.height;
    int const side = std::min(width, height);
    if (side < 2) {
        return {};
    }
    std::vector<double> const columns = hann(width), rows = hann(height);
    RealDft dft({height, width}, 1);
    fill_windowed(picture, columns, rows, dft.signal());
    dft.execute();

    std::vector<SpectrumPoint> rings(static_cast<std::size_t>(side / 2));
    std::vector<double> counts(rings.size());
    auto const transform_width = static_cast<std::size_t>(width) / 2 + 1;
    for (int v = 0; v < height; ++v) {
        double const fy = static_cast<double>(std::min(v, height - v)) / height;
        for (int u = 0; u <= width / 2; ++u) {
            double const frequency = std::hypot(static_cast<double>(u) / width, fy);
            auto const ring = std::lround(frequency * side);
            if (ring < 1 || ring > side / 2) {
                continue;
            }
            double const count = u == 0 || 2 * u == width ? 1 : 2; // the other half plane is the mirror image
            auto const i = static_cast<std::size_t>(ring - 1);
            rings[i].power +=
                count * dft.power(static_cast<std::size_t>(v) * transform_width + static_cast<std::size_t>(u));
            counts[i] += count;
        }
    }
    double const window_power = sum_of_squares(columns) * sum_of_squares(rows);
    for (std::size_t i = 0; i < rings.size(); ++i) {
        rings[i].frequency = static_cast<double>(i + 1) / side;
        rings[i].power /= counts[i] * window_power;
    }
    return rings;
}

std::vector<SpectrumPoint> temporal_power(std::span<Picture const> pictures) {
    for (Picture const& picture : pictures) {
        if (picture.width != pictures[0].width || picture.height != pictures[0].height) {
            throw InputError("the pictures of a sequence differ in size");
        }
    }
    if (pictures.size() < 2 || pictures[0].rgba.empty()) {
        return {};
    }
    int const width = pictures[0].width, height = pictures[0].height;
    int const times = static_cast<int>(pictures.size());
    std::vector<double> const window = hann(times);
    RealDft dft({times}, width);
    std::vector<SpectrumPoint> points(pictures.size() / 2);
    std::size_t const stride = points.size() + 1;
    for (int y = 0; y < height; ++y) {
        fill_row(pictures, y, window, dft.signal());
        dft.execute();
        for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
            for (std::size_t i = 0; i < points.size(); ++i) {
                points[i].power += dft.power(x * stride + i + 1);
            }
        }
    }
    double const scale = 1 / (sum_of_squares(window) * static_cast<double>(width) * height);
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i].frequency = static_cast<double>(i + 1) / times;
        points[i].power *= scale;
    }
    return points;
}

double log_log_slope(std::span<SpectrumPoint const> spectrum) {
    std::size_t count = 0;
    double weights = 0, mean_x = 0, mean_y = 0, xx = 0, xy = 0;
    for (std::size_t i = first_point; i < spectrum.size() && spectrum[i].frequency <= highest_frequency; ++i) {
        double const weight = 1 / spectrum[i].frequency; // points lie the denser in an octave the higher it is
        double const dx = std::log(spectrum[i].frequency) - mean_x;
        double const dy = std::log(std::max(spectrum[i].power, least_power)) - mean_y;
        weights += weight;
        mean_x += dx * weight / weights;
        mean_y += dy * weight / weights;
        double const change = weight * (1 - weight / weights) * dx;
        xx += change * dx;
        xy += change * dy;
        ++count;
    }
    return count < least_points ? 0 : xy / xx;
}

double power_spectrum_slope(Picture const& picture) {
    return log_log_slope(radial_power(picture));
}

double temporal_spectrum_slope(std::span<Picture const> pictures) {
    return log_log_slope(temporal_power(pictures));
}

} // namespace framelet::bench
