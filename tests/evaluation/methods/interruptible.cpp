// The method `interruptible`: whole frames from coarse to fine ([Woolley 2003]), shown level by level. A frame is given
// up for a new one when what has moved since would cost more than the next level brings; the new one begins with the
// coarsest level that is better than what is on display. While nothing moves, samples are added until the picture is as
// good as it gets. Coded by x264 as `framed+h264`.
#include "tests/evaluation/methods/interruptible.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "tests/evaluation/methods/methods.h"

namespace framelet::bench {

Interruptible::Interruptible(MethodSetup const& setup)
    : setup_(setup), rate_{setup.bits_per_second > 0 ? setup.bits_per_second / 8 : INFINITY},
      forecast_(setup, 1e-9 * pixel_count(setup.viewport) * setup.costs.h264_decode_pixel),
      grids_{FrameGrid(setup.viewport, 4), FrameGrid(setup.viewport, 2), FrameGrid(setup.viewport, 1)},
      encoder_(setup.frames_per_second), viewer_(setup) {}

ServerStep Interruptible::produce(StepInput const& input) {
    for (DeliveredMessage const& message : input.delivered) {
        rate_ = update_delivery_rate(rate_, message.bytes, message.seconds);
    }
    FrameMoment const moment =
        setup_.rivals.ahead ? forecast_.moment(input) : FrameMoment{input.view.camera, input.time};
    pose_at(input.scene, moment.time);
    bool const still = is_still(input, moment);
    if (still) {
        gain_.forget_motion();
    }
    if (still && level_ == last_level && grids_[last_level].frames() == FrameGrid::offsets) {
        return {};
    }
    begins_ = !still && (level_ < 0 || level_ == last_level || is_outdated(input.now));
    if (begins_) {
        level_ = first_level(input.now) - 1;
        meant_ = input.now + forecast_.lead();
        moment_ = moment;
        pose_ = input.scene.pose;
        ++frame_;
    }
    return render(input, still);
}

bool Interruptible::is_still(StepInput const& input, FrameMoment const& moment) const {
    return level_ >= 0 && moment.camera == moment_.camera && same_pose(input.scene.pose, pose_);
}

/// The coarsest level that, when it is rendered, will be nearer to the scene than the picture on display, which the
/// scene will have moved away from by then.
int Interruptible::first_level(double now) const {
    if (level_ < 0) {
        return 0;
    }
    int level = 0;
    while (level < last_level &&
           gain_.residual(level) >=
               gain_.residual(level_) + gain_.drift(now + seconds_[static_cast<std::size_t>(level)] - meant_)) {
        ++level;
    }
    return level;
}

bool Interruptible::is_outdated(double now) const {
    auto const next = static_cast<std::size_t>(level_ + 1);
    return gain_.drift(now + seconds_[next] - meant_) > gain_.gain(level_);
}

ServerStep Interruptible::render(StepInput const& input, bool still) {
    pose_at(input.scene, moment_.time);
    RenderScene const& scene = *input.scene.render_scene;
    float const exposure = input.scene.exposure;
    bool const adds = level_ == last_level && !begins_;
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
        gain_.add(frame_, level_, picture, still ? NAN : meant_);
    } else if (!std::has_single_bit(static_cast<unsigned>(grid.frames()))) {
        return step; // a mean is sent once its samples have doubled: what is in between brings little
    }
    double const encoding = 1e-9 * samples * costs.h264_encode_pixel;
    double const period = setup_.machine * (step.seconds.server() + encoding);
    auto const bytes = encoder_.encode(grid.spacing(), picture, frame_budget(rate_, period, input.waiting_bytes));
    step.message = frame_message({moment_.time, static_cast<double>(grid.spacing())}, bytes);
    step.seconds.encode += encoding;
    seconds_[static_cast<std::size_t>(level_)] = setup_.machine * step.seconds.server();
    if (begins_) {
        forecast_.begin(input.now, true);
    } else {
        forecast_.follow(input.now);
    }
    return step;
}

std::unique_ptr<Method> make_interruptible(MethodSetup const& setup) {
    return std::make_unique<Interruptible>(setup);
}

} // namespace framelet::bench
