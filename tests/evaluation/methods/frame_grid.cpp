#include "tests/evaluation/methods/frame_grid.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>

#include <tbb/parallel_for.h>

#include "common/color.h"
#include "common/error.h"
#include "tests/uniform_tiling.h"

namespace framelet::bench {
namespace {

/// Sampling offset of frame number `frame` (the first is 0) from the middle of a cell, in cell sides: the sequence of
/// [Sobol 1967], of which the first 2, 4, 8 and so on are each as even as can be, shifted so that it begins in the
/// middle. The mean of all offsets is 0.
Vec2 offset_of(int frame) {
    auto const i = static_cast<std::uint32_t>(frame);
    constexpr std::uint32_t count = FrameGrid::offsets;
    std::uint32_t x = 0, y = 0;
    for (std::uint32_t bit = 0, row = count / 2; count >> bit > 1; ++bit, row ^= row >> 1) {
        x |= (i >> bit & 1) * (count / 2 >> bit);
        y ^= (i >> bit & 1) * row;
    }
    constexpr float step = 1.0f / count;
    Vec2 const column_row((x + count / 2) % count, (y + count / 2) % count);
    return column_row * step + Vec2(0.5f * step - 0.5f);
}

int samples_along(int pixels, int spacing) {
    return (pixels + spacing - 1) / spacing;
}

/// Position of a pixel between two samples of a row or column.
struct Between {
    int first = 0, second = 0;
    float share = 0; ///< weight of the second sample
};

Between between(int pixel, int spacing, int samples) {
    float const at = (static_cast<float>(pixel) + 0.5f) / static_cast<float>(spacing) - 0.5f;
    int const first = static_cast<int>(std::floor(at));
    return {std::clamp(first, 0, samples - 1), std::clamp(first + 1, 0, samples - 1), at - static_cast<float>(first)};
}

} // namespace

FrameGrid::FrameGrid(Viewport viewport, int spacing)
    : plane_(viewport), spacing_(spacing),
      tiles_(
          make_uniform_tiling(plane_, plane_.pixel_depth() - std::countr_zero(static_cast<unsigned>(spacing))).tiles),
      rendered_(tiles_.size()), sums_(tiles_.size()), displayed_(tiles_.size()),
      picture_(samples_along(viewport.width, spacing), samples_along(viewport.height, spacing)) {
    FRAMELET_CHECK(spacing == 1 || spacing == 2 || spacing == 4);
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
        displayed_[i].tile = tiles_[i];
    }
}

std::uint64_t FrameGrid::render(RenderScene const& scene, Camera const& camera, float exposure) {
    frames_ = 0;
    std::uint64_t const segments = render_at(scene, camera, Vec2(0), rendered_);
    show(rendered_, exposure);
    return segments;
}

std::uint64_t FrameGrid::add(RenderScene const& scene, Camera const& camera, float exposure) {
    FRAMELET_CHECK(frames_ > 0);
    fresh_.resize(tiles_.size());
    std::uint64_t const segments = render_at(scene, camera, offset_of(frames_) * static_cast<float>(spacing_), fresh_);
    show(fresh_, exposure);
    return segments;
}

std::uint64_t FrameGrid::render_at(RenderScene const& scene, Camera const& camera, Vec2 offset,
                                   std::span<Framelet> out) const {
    ViewRays rays = make_view_rays(camera, plane_.viewport());
    rays.origin += rays.origin_dx * offset.x + rays.origin_dy * offset.y;
    rays.direction += rays.direction_dx * offset.x + rays.direction_dy * offset.y;
    std::atomic<std::uint64_t> segments{0};
    tbb::parallel_for(std::size_t{0}, tiles_.size(), [&](std::size_t i) {
        segments.fetch_add(render_framelet(scene, rays, plane_, tiles_[i], out[i]), std::memory_order_relaxed);
    });
    return segments;
}

void FrameGrid::show(std::vector<Framelet> const& newest, float exposure) {
    ++frames_;
    float const share = 1 / static_cast<float>(frames_);
    tbb::parallel_for(std::size_t{0}, tiles_.size(), [&](std::size_t t) {
        Framelet const& from = newest[t];
        DisplayFramelet& to = displayed_[t];
        for (std::size_t i = 0; i < framelet_samples; ++i) {
            Vec3 const light = tone_map(Vec3(from.red[i], from.green[i], from.blue[i]) * exposure);
            std::array<std::uint8_t*, 3> const bytes{&to.red[i], &to.green[i], &to.blue[i]};
            for (std::size_t c = 0; c < 3; ++c) {
                float& sum = sums_[t][c][i];
                sum = (frames_ > 1 ? sum : 0) + light[static_cast<int>(c)];
                *bytes[c] = srgb_byte_from_linear(sum * share);
            }
        }
    });
}

Picture const& FrameGrid::picture() {
    for (DisplayFramelet const& framelet : displayed_) {
        write_samples(framelet, picture_);
    }
    return picture_;
}

void upsample(Picture const& samples, int spacing, Picture& out) {
    FRAMELET_CHECK(samples.width == samples_along(out.width, spacing) &&
                   samples.height == samples_along(out.height, spacing));
    if (spacing == 1) {
        out.rgba = samples.rgba;
        return;
    }
    tbb::parallel_for(0, out.height, [&](int y) {
        Between const rows = between(y, spacing, samples.height);
        std::uint8_t const* const upper = samples.row(rows.first);
        std::uint8_t const* const lower = samples.row(rows.second);
        std::uint8_t* pixel = out.row(y);
        for (int x = 0; x < out.width; ++x, pixel += 4) {
            Between const columns = between(x, spacing, samples.width);
            for (int c = 0; c < 3; ++c) {
                auto const across = [&](std::uint8_t const* row) {
                    float const left = linear_from_srgb_byte(row[4 * columns.first + c]);
                    return left + columns.share * (linear_from_srgb_byte(row[4 * columns.second + c]) - left);
                };
                float const above = across(upper);
                pixel[c] = srgb_byte_from_linear(above + rows.share * (across(lower) - above));
            }
            pixel[3] = 255;
        }
    });
}

void write_samples(DisplayFramelet const& framelet, Picture& picture) {
    int const left = static_cast<int>(framelet.tile.column()) * framelet_side;
    int const top = static_cast<int>(framelet.tile.row()) * framelet_side;
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        int const x = left + static_cast<int>(morton_x(i));
        int const y = top + static_cast<int>(morton_y(i));
        if (x < picture.width && y < picture.height) {
            std::uint8_t* const pixel = picture.row(y) + static_cast<std::ptrdiff_t>(x) * 4;
            pixel[0] = framelet.red[i];
            pixel[1] = framelet.green[i];
            pixel[2] = framelet.blue[i];
            pixel[3] = 255;
        }
    }
}

void take_samples(Picture const& picture, DisplayFramelet& framelet) {
    int const left = static_cast<int>(framelet.tile.column()) * framelet_side;
    int const top = static_cast<int>(framelet.tile.row()) * framelet_side;
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        int const x = std::min(left + static_cast<int>(morton_x(i)), picture.width - 1);
        int const y = std::min(top + static_cast<int>(morton_y(i)), picture.height - 1);
        std::uint8_t const* const pixel = picture.row(y) + static_cast<std::ptrdiff_t>(x) * 4;
        framelet.red[i] = pixel[0];
        framelet.green[i] = pixel[1];
        framelet.blue[i] = pixel[2];
    }
}

} // namespace framelet::bench
