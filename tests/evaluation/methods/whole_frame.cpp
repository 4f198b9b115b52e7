#include "tests/evaluation/methods/whole_frame.h"

#include <algorithm>
#include <cmath>

namespace framelet::bench {
namespace {

/// Factor by which a mean must have more samples than the one sent last to be better by enough to be sent.
constexpr double worth_sending = 4.0 / 3;
/// Greatest length of unused link time, seconds, that may be spent at once by a later frame.
constexpr double longest_saved = 0.25;
/// Bytes a pixel of a repeated picture above which it had not come through as well as it might.
constexpr double worth_repeating = 1.0 / 32;
constexpr int most_repeats = 16;

} // namespace

WholeFrame::WholeFrame(MethodSetup const& setup, double viewer_seconds)
    : costs_(setup.costs), machine_(setup.machine), parts_(setup.rivals),
      margin_x_(margin_pixels(parts_.margin, setup.viewport.width)),
      margin_y_(margin_pixels(parts_.margin, setup.viewport.height)), rate_{setup.bits_per_second > 0
                                                                                ? setup.bits_per_second / 8
                                                                                : INFINITY},
      forecast_(setup, viewer_seconds),
      moving_(with_margin(setup.viewport, margin_x_, margin_y_), std::max(parts_.spacing, 1)) {
    view_.viewport = moving_.plane().viewport();
    if (parts_.accumulate && moving_.spacing() > 1) {
        still_.emplace(view_.viewport, 1);
    }
}

std::vector<int> WholeFrame::spacings() const {
    return still_ ? std::vector{moving_.spacing(), 1} : std::vector{moving_.spacing()};
}

bool WholeFrame::is_still(StepInput const& input, FrameMoment const& moment) const {
    return view_.number > 0 && moment.camera == moment_.camera && input.scene.exposure == exposure_ &&
           (moment.time == moment_.time || same_pose(input.scene.pose, pose_));
}

void WholeFrame::begin(StepInput const& input, FrameMoment const& moment) {
    if (view_.number == 0 || !(moment.camera == moment_.camera)) {
        Viewport const inner{view_.viewport.width - 2 * margin_x_, view_.viewport.height - 2 * margin_y_};
        view_.camera = with_margin(moment.camera, inner, margin_y_);
        ++view_.number;
    }
    exposure_ = input.scene.exposure;
    pose_ = input.scene.pose;
    passes_ = sent_passes_ = repeated_ = 0;
    shown_ = &moving_;
}

ServerStep WholeFrame::render(StepInput const& input) {
    FrameMoment const now{input.view.camera, input.time};
    FrameMoment const moment = parts_.ahead ? forecast_.moment(input) : now;
    pose_at(input.scene, moment.time);
    bool const still = parts_.accumulate && is_still(input, moment);
    due_ = false;
    if (still && is_converged()) {
        moment_.time = moment.time;
        return {};
    }
    if (!still) {
        begin(input, moment);
    }
    moment_ = moment;
    RenderScene const& scene = *input.scene.render_scene;
    std::uint64_t segments = 0;
    if (!still || (passes_ == 0 && still_)) {
        shown_ = still ? &*still_ : &moving_;
        segments = shown_->render(scene, view_.camera, exposure_);
    } else {
        segments = shown_->add(scene, view_.camera, exposure_);
    }
    passes_ = shown_->spacing() == 1 ? shown_->frames() : 0;
    due_ = passes_ <= 1 || is_converged() || passes_ >= worth_sending * sent_passes_;
    if (due_) {
        sent_passes_ = passes_;
        forecast_.begin(input.now, !still);
    }
    ServerStep step;
    step.samples = shown_->samples();
    double const samples = static_cast<double>(step.samples);
    step.seconds.render = 1e-9 * static_cast<double>(segments) * costs_.coherent_segment;
    step.seconds.encode = 1e-9 * samples * (costs_.display_sample + (passes_ > 1 ? costs_.place_pixel : 0));
    return step;
}

void WholeFrame::sent(double now) {
    forecast_.sent(now);
    sent_at_ = now;
}

double WholeFrame::budget(StepInput const& input, ServerStep const& rendered, double encode_seconds) {
    for (DeliveredMessage const& message : input.delivered) {
        rate_ = update_delivery_rate(rate_, message.bytes, message.seconds);
    }
    double period = machine_ * (rendered.seconds.server() + encode_seconds);
    if (sent_passes_ > 1) {
        period += std::clamp(input.now - sent_at_, 0.0, longest_saved);
    }
    return frame_budget(rate_, period, input.waiting_bytes);
}

bool WholeFrame::repeats(StepInput const& input, std::size_t last_bytes) {
    bool const more = is_converged() && repeated_ < most_repeats && std::isfinite(rate_.bytes_per_second) &&
                      input.waiting_bytes == 0 &&
                      static_cast<double>(last_bytes) > worth_repeating * pixel_count(viewport());
    if (more) {
        repeat(input.now);
    }
    return more;
}

} // namespace framelet::bench
