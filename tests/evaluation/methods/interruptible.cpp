// `interruptible`: whole frames from coarse to fine (Woolley et al. 2003, "Interruptible rendering"), shown level by
// level. A frame is given up for a new one when what has moved since would cost more than the next level brings; while
// nothing moves, samples are added until the picture is as good as it gets. Through x264 as `framed+h264`.
#include "tests/evaluation/methods/interruptible.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "tests/evaluation/methods/frame_message.h"
#include "tests/evaluation/methods/methods.h"

namespace framelet::bench {

Interruptible::Interruptible(MethodSetup const& setup)
    : setup_(setup), rate_{setup.bits_per_second > 0 ? setup.bits_per_second / 8 : INFINITY},
      forecast_(setup, 1e-9 * pixel_count(setup.viewport) * setup.costs.h264_decode_pixel),
      grids_{FrameGrid(setup.viewport, 4), FrameGrid(setup.viewport, 2), FrameGrid(setup.viewport, 1)},
      encoder_(setup.frames_per_second), picture_(setup.viewport.width, setup.viewport.height) {}

ServerStep Interruptible::produce(StepInput const& input) {
    for (DeliveredMessage const& message : input.delivered) {
        rate_ = update_delivery_rate(rate_, message.bytes, message.seconds);
    }
    FrameMoment const moment =
        setup_.rivals.ahead ? forecast_.moment(input) : FrameMoment{input.view.camera, input.time};
    bool const still = level_ >= 0 && moment.camera == moment_.camera && moment.time == moment_.time;
    if (still) {
        gain_.forget_motion();
    }
    if (still && level_ == last_level && grids_[last_level].frames() == FrameGrid::places) {
        return {};
    }
    if (!still && (level_ < 0 || level_ == last_level || is_outdated(input.now))) {
        meant_ = input.now + forecast_.lead();
        moved_ = meant_ - last_meant_;
        last_meant_ = meant_;
        moment_ = moment;
        level_ = -1;
    }
    return render(input, still);
}

bool Interruptible::is_outdated(double now) const {
    auto const next = static_cast<std::size_t>(level_ + 1);
    return gain_.drift(now + seconds_[next] - meant_) > gain_.gain(level_);
}

ServerStep Interruptible::render(StepInput const& input, bool still) {
    pose_at(input.scene, moment_.time);
    RenderScene const& scene = *input.scene.render_scene;
    float const exposure = input.scene.exposure;
    bool const adds = level_ == last_level;
    level_ = std::min(level_ + 1, last_level);
    FrameGrid& grid = grids_[static_cast<std::size_t>(level_)];
    std::uint64_t const segments =
        adds ? grid.add(scene, moment_.camera, exposure) : grid.render(scene, moment_.camera, exposure);
    ServerStep step;
    step.samples = grid.samples();
    double const samples = static_cast<double>(step.samples);
    CostTable const& costs = setup_.costs;
    step.seconds.render = 1e-9 * static_cast<double>(segments) * costs.coherent_segment;
    step.seconds.encode = 1e-9 * samples * (costs.display_sample + (adds ? costs.place_pixel : 0));
    Picture const& picture = grid.picture();
    if (!adds) {
        step.seconds.response = 1e-9 * samples * costs.estimate_sample;
        if (level_ == 0 && !still) {
            gain_.add_moved(picture, moved_);
        } else {
            gain_.add_level(level_, picture);
        }
    } else if (!std::has_single_bit(static_cast<unsigned>(grid.frames()))) {
        return step; // of as many samples again: what is in between brings little
    }
    double const encoding = 1e-9 * samples * costs.h264_encode_pixel;
    double const period = setup_.machine * (step.seconds.server() + encoding);
    auto const bytes = encoder_.encode(grid.spacing(), picture, frame_budget(rate_, period, input.waiting_bytes));
    step.message = frame_message({moment_.time, static_cast<double>(grid.spacing())}, bytes);
    step.seconds.encode += encoding;
    seconds_[static_cast<std::size_t>(level_)] = setup_.machine * step.seconds.server();
    if (level_ == 0) {
        forecast_.begin(input.now, !still);
    } else {
        forecast_.follow(input.now);
    }
    return step;
}

ViewerStep Interruptible::consume(std::vector<std::byte> const& message) {
    auto const unit = access_unit(message, header_);
    auto const spacing = static_cast<int>(header_.spacing);
    decoder_.decode(spacing, unit, decoded_);
    upsample(decoded_, spacing, picture_);
    ViewerStep step;
    step.seconds.decode = 1e-9 * pixel_count(decoded_) * setup_.costs.h264_decode_pixel;
    step.seconds.reconstruct = spacing > 1 ? 1e-9 * pixel_count(picture_) * setup_.costs.reconstruct_pixel : 0;
    return step;
}

std::unique_ptr<Method> make_interruptible(MethodSetup const& setup) {
    return std::make_unique<Interruptible>(setup);
}

} // namespace framelet::bench
