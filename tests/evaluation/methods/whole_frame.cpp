#include "tests/evaluation/methods/whole_frame.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <tbb/parallel_for.h>

#include "common/color.h"
#include "server/schedule/tiling.h"

namespace framelet::bench {

WholeFrame::WholeFrame(MethodSetup const& setup)
    : costs_(setup.costs),
      machine_(setup.machine), rate_{setup.bits_per_second > 0 ? setup.bits_per_second / 8 : INFINITY},
      plane_(setup.viewport), tiles_(make_uniform_tiling(plane_, plane_.pixel_depth()).tiles), rendered_(tiles_.size()),
      displayed_(tiles_.size()), picture_(setup.viewport.width, setup.viewport.height),
      pixels_(picture_.rgba.size() / 4) {
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
        displayed_[i].tile = tiles_[i];
    }
}

ServerStep WholeFrame::render(StepInput const& input) {
    ServerStep step;
    std::uint64_t const segments =
        render_framelets(*input.scene.render_scene, input.view.camera, plane_, tiles_, 0, rendered_);
    tbb::parallel_for(std::size_t(0), rendered_.size(),
                      [&](std::size_t i) { displayed_[i] = to_display(rendered_[i], input.scene.exposure); });
    step.samples = tiles_.size() * framelet_samples;
    step.seconds.render = 1e-9 * static_cast<double>(segments) * costs_.coherent_segment;
    step.seconds.encode = 1e-9 * static_cast<double>(step.samples) * costs_.display_sample;
    return step;
}

double WholeFrame::budget(StepInput const& input, ServerStep const& rendered, double encode_seconds) {
    for (DeliveredMessage const& message : input.delivered) {
        rate_ = update_delivery_rate(rate_, message.bytes, message.seconds);
    }
    double const period = machine_ * (rendered.seconds.server() + encode_seconds);
    return frame_budget(rate_, period, input.waiting_bytes);
}

Picture const& WholeFrame::picture() {
    for (DisplayFramelet const& framelet : displayed_) {
        place_framelet(framelet, plane_, picture_);
    }
    return picture_;
}

std::vector<std::byte> WholeFrame::timed(SceneTime time, std::span<std::byte const> access_unit) {
    std::vector<std::byte> message(sizeof(time) + access_unit.size());
    std::memcpy(message.data(), &time, sizeof(time));
    std::ranges::copy(access_unit, message.begin() + std::ptrdiff_t{sizeof(time)});
    return message;
}

std::span<std::byte const> WholeFrame::untimed(std::span<std::byte const> message, SceneTime& time) {
    std::memcpy(&time, message.data(), sizeof(time));
    return message.subspan(sizeof(time));
}

void place_framelet(DisplayFramelet const& framelet, ImagePlane const& plane, Picture& picture) {
    PixelRect const rect = plane.tile_rect(framelet.tile);
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        int const x = rect.left + static_cast<int>(morton_x(i));
        int const y = rect.top + static_cast<int>(morton_y(i));
        if (x < picture.width && y < picture.height) {
            std::uint8_t* const pixel = picture.row(y) + static_cast<std::ptrdiff_t>(x) * 4;
            pixel[0] = framelet.red[i];
            pixel[1] = framelet.green[i];
            pixel[2] = framelet.blue[i];
            pixel[3] = 255;
        }
    }
}

void take_framelet(Picture const& picture, ImagePlane const& plane, DisplayFramelet& framelet) {
    PixelRect const rect = plane.tile_rect(framelet.tile);
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        int const x = std::min(rect.left + static_cast<int>(morton_x(i)), picture.width - 1);
        int const y = std::min(rect.top + static_cast<int>(morton_y(i)), picture.height - 1);
        std::uint8_t const* const pixel = picture.row(y) + static_cast<std::ptrdiff_t>(x) * 4;
        framelet.red[i] = pixel[0];
        framelet.green[i] = pixel[1];
        framelet.blue[i] = pixel[2];
    }
}

} // namespace framelet::bench
