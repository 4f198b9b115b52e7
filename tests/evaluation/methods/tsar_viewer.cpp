#include "tests/evaluation/methods/tsar_viewer.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "common/color.h"

namespace framelet::bench {
namespace {

constexpr int channels = 5;
constexpr int band = 16; ///< rows that one task draws

/// Radius of the box that smooths the age field: its width is 128 pixels of 512 (Table 7.1). [Stephens 2011] does not
/// say how it scales with resolution, nor what shape it has: here a box over the same part of the picture.
int smoothing_radius(Viewport viewport) {
    return std::max(viewport.width, viewport.height) / 8;
}

/// Applies a box filter of 2 * radius + 1 values, `step` apart, narrower at the ends.
void box_filter(float const* in, float* out, int count, std::ptrdiff_t step, int radius) {
    double sum = 0;
    int first = 0, last = -1;
    for (int i = 0; i < count; ++i) {
        for (; last < std::min(i + radius, count - 1);) {
            sum += in[++last * step];
        }
        for (; first < i - radius;) {
            sum -= in[first++ * step];
        }
        out[i * step] = static_cast<float>(sum / (last - first + 1));
    }
}

} // namespace

TsarViewer::TsarViewer(ImagePlane plane) : plane_(plane), picture_(plane.viewport().width, plane.viewport().height) {
    std::size_t const pixels = picture_.rgba.size() / 4;
    newest_.resize(pixels);
    smooth_.resize(pixels);
    sums_.resize(pixels * channels);
    for (std::size_t i = 3; i < picture_.rgba.size(); i += 4) {
        picture_.rgba[i] = 255;
    }
}

BlendWork TsarViewer::show(std::vector<DisplayFramelet> const& framelets, double time, SceneTime scene_time) {
    // Half the finest step of time that there is: the newest samples of a place get this much weight (section 4.2.3).
    half_step_ = held_.empty() ? 1e-3f : std::max(1e-4f, 0.5f * (static_cast<float>(time) - held_.back().time));
    auto const& linear = transfer_tables().linear;
    for (DisplayFramelet const& framelet : framelets) {
        Held& held = held_.emplace_back();
        held.tile = framelet.tile;
        held.time = static_cast<float>(time);
        held.scene_time = static_cast<float>(scene_time);
        PixelRect const rect = plane_.tile_rect(framelet.tile);
        float const margin = 0.5f * plane_.sample_spacing(framelet.tile) - 0.5f;
        auto const first = [&](int side) { return std::max(0, int(std::floor(float(side) - margin - 1)) + 1); };
        auto const end = [&](int side, int most) { return std::min(most, int(std::ceil(float(side) + margin))); };
        held.extent = {first(rect.left), first(rect.top), end(rect.right, picture_.width),
                       end(rect.bottom, picture_.height)};
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            std::size_t const row_order = framelet_side * morton_y(i) + morton_x(i);
            held.linear[0][row_order] = linear[framelet.red[i]];
            held.linear[1][row_order] = linear[framelet.green[i]];
            held.linear[2][row_order] = linear[framelet.blue[i]];
        }
    }
    draw_ages();
    smooth_ages();
    std::fill(sums_.begin(), sums_.end(), 0.0f);
    int const bands = (picture_.height + band - 1) / band;
    std::vector<std::vector<std::uint8_t>> used(static_cast<std::size_t>(bands));
    std::vector<double> work(used.size());
    tbb::parallel_for(0, bands, [&](int i) {
        auto const index = static_cast<std::size_t>(i);
        used[index].resize(held_.size());
        work[index] = accumulate(i * band, std::min((i + 1) * band, picture_.height), used[index]);
    });
    normalise();
    // A framelet that is older than the smoothed age everywhere will not be seen again (section 3.4.4.4).
    std::size_t kept = 0;
    for (std::size_t i = 0; i < held_.size(); ++i) {
        if (std::ranges::any_of(used, [i](auto const& band_used) { return band_used[i] != 0; })) {
            if (kept != i) {
                held_[kept] = held_[i];
            }
            ++kept;
        }
    }
    held_.resize(kept);
    return {static_cast<double>(newest_.size()), std::accumulate(work.begin(), work.end(), 0.0)};
}

void TsarViewer::draw_ages() {
    // A pixel that nothing covers yet counts as old as the oldest framelet.
    std::fill(newest_.begin(), newest_.end(), held_.front().time);
    for (Held const& held : held_) { // newer ones come later and overwrite older ones
        for (int y = held.extent.top; y < held.extent.bottom; ++y) {
            auto const row = newest_.begin() + static_cast<std::ptrdiff_t>(y) * picture_.width;
            std::fill(row + held.extent.left, row + held.extent.right, held.time);
        }
    }
}

void TsarViewer::smooth_ages() {
    int const radius = smoothing_radius(plane_.viewport());
    int const width = picture_.width, height = picture_.height;
    std::vector<float> rows(newest_.size());
    tbb::parallel_for(0, height, [&](int y) {
        std::ptrdiff_t const row = static_cast<std::ptrdiff_t>(y) * width;
        box_filter(newest_.data() + row, rows.data() + row, width, 1, radius);
    });
    tbb::parallel_for(0, width, [&](int x) { box_filter(rows.data() + x, smooth_.data() + x, height, width, radius); });
    for (std::size_t i = 0; i < smooth_.size(); ++i) {
        smooth_[i] = std::min(smooth_[i], newest_[i]);
    }
}

/// Taps of a tent filter about each sample, of radius one sample spacing or one pixel, whichever is more.
TsarViewer::Taps TsarViewer::taps(Tile tile, int origin, int pixel) const {
    float const spacing = plane_.sample_spacing(tile);
    float const radius = std::max(spacing, 1.0f) / spacing; // radius in samples
    float const centre = (static_cast<float>(pixel - origin) + 0.5f) / spacing - 0.5f;
    Taps out;
    out.first = std::max(0, static_cast<int>(std::floor(centre - radius)) + 1);
    int const last = std::min(framelet_side - 1, static_cast<int>(std::ceil(centre + radius)) - 1);
    out.count = last - out.first + 1;
    for (int i = 0; i < out.count; ++i) {
        out.weights[static_cast<std::size_t>(i)] = 1 - std::abs(static_cast<float>(out.first + i) - centre) / radius;
    }
    return out;
}

/// Adds to the rows from `top` to `bottom` what every framelet contributes, and notes in `used` which did. Returns the
/// number of contributions.
double TsarViewer::accumulate(int top, int bottom, std::vector<std::uint8_t>& used) {
    std::uint64_t taken = 0;
    std::vector<Taps> columns;
    for (std::size_t h = 0; h < held_.size(); ++h) {
        Held const& held = held_[h];
        PixelRect const& extent = held.extent;
        if (extent.top >= bottom || extent.bottom <= top) {
            continue;
        }
        PixelRect const rect = plane_.tile_rect(held.tile);
        columns.clear();
        for (int x = extent.left; x < extent.right; ++x) {
            columns.push_back(taps(held.tile, rect.left, x));
        }
        for (int y = std::max(top, extent.top); y < std::min(bottom, extent.bottom); ++y) {
            Taps const rows = taps(held.tile, rect.top, y);
            std::size_t const row = static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width);
            for (int x = extent.left; x < extent.right; ++x) {
                std::size_t const pixel = row + static_cast<std::size_t>(x);
                float const newer = held.time + half_step_ - smooth_[pixel];
                if (newer <= 0) {
                    continue;
                }
                Taps const& across = columns[static_cast<std::size_t>(x - extent.left)];
                std::array<float, 4> sum{};
                for (int j = 0; j < rows.count; ++j) {
                    for (int i = 0; i < across.count; ++i) {
                        float const weight =
                            rows.weights[static_cast<std::size_t>(j)] * across.weights[static_cast<std::size_t>(i)];
                        auto const sample =
                            static_cast<std::size_t>(framelet_side * (rows.first + j) + across.first + i);
                        sum[0] += weight * held.linear[0][sample];
                        sum[1] += weight * held.linear[1][sample];
                        sum[2] += weight * held.linear[2][sample];
                        sum[3] += weight;
                    }
                }
                float* const out = sums_.data() + pixel * channels;
                out[0] += newer * sum[0];
                out[1] += newer * sum[1];
                out[2] += newer * sum[2];
                out[3] += newer * sum[3] * held.scene_time;
                out[4] += newer * sum[3];
                taken += static_cast<std::uint64_t>(rows.count * across.count);
                used[h] = 1;
            }
        }
    }
    return static_cast<double>(taken) / 4;
}

void TsarViewer::normalise() {
    double times = 0;
    for (std::size_t pixel = 0; pixel < newest_.size(); ++pixel) {
        float const* const sum = sums_.data() + pixel * channels;
        if (sum[4] > 0) { // a hole, for which nothing has come yet, stays as it is
            for (std::size_t c = 0; c < 3; ++c) {
                picture_.rgba[pixel * 4 + c] = srgb_byte_from_linear(sum[c] / sum[4]);
            }
            times += double(sum[3]) / sum[4];
        }
    }
    mean_scene_time_ = times / static_cast<double>(newest_.size());
}

} // namespace framelet::bench
