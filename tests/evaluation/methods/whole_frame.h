// Whole frames in turn, at their best: what every `framed` method renders. Each is for the moment at which it will be
// shown, at the spacing of the setup; while nothing moves, more samples are taken of all pixels until the picture is
// as good as it gets. In: scene and view. Out: the samples of one frame, and what they cost.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tests/evaluation/codecs/delivery_rate.h"
#include "tests/evaluation/methods/frame_forecast.h"
#include "tests/evaluation/methods/frame_grid.h"
#include "tests/evaluation/methods/margin.h"

namespace framelet::bench {

class WholeFrame {
public:
    /// `viewer_seconds`: from a frame's arrival until it shows.
    WholeFrame(MethodSetup const& setup, double viewer_seconds);

    /// Renders a frame of the view, or adds to the last one. Seconds: render, and under `encode` the tone curve and the
    /// mean. Neither costs nor samples: there is nothing to gain.
    ServerStep render(StepInput const& input);
    /// Whether what was rendered is to be sent: it is better by enough than what was.
    bool is_due() const { return due_; }
    /// Nothing moves, and more samples would not make it better.
    bool is_converged() const { return passes_ == FrameGrid::places; }
    /// Whether a picture that has converged is to be coded once more, as long as its codec still has something to say
    /// of it and nothing else is on its way. `last_bytes`: what it took the last time.
    bool repeats(StepInput const& input, std::size_t last_bytes);
    /// What was rendered is sent once more.
    void repeat(double now) {
        ++repeated_;
        forecast_.follow(now);
    }

    /// What was rendered last, and for when.
    FrameGrid& grid() { return *shown_; }
    NumberedView const& view() const { return view_; }
    SceneTime time() const { return moment_.time; }

    /// The viewport with its margin, which is what is rendered. Spacings that frames may have.
    Viewport viewport() const { return moving_.plane().viewport(); }
    std::vector<int> spacings() const;

    void sent(double now);
    void answered(double arrived) { forecast_.answered(arrived); }

    /// Bytes that the encoder may make of the frame last rendered, for a link that it shall neither fill nor leave
    /// idle: from what the answers say and from how long a frame takes. `encode_seconds`: what encoding costs,
    /// calibrated.
    double budget(StepInput const& input, ServerStep const& rendered, double encode_seconds);

private:
    bool is_still(StepInput const& input, FrameMoment const& moment) const;
    void begin(StepInput const& input, FrameMoment const& moment);

    CostTable const costs_;
    double const machine_;
    RivalParts const parts_;
    int const margin_x_, margin_y_; ///< pixels
    DeliveryRate rate_;
    FrameForecast forecast_;
    FrameGrid moving_;
    std::optional<FrameGrid> still_; ///< where it differs
    FrameGrid* shown_ = &moving_;
    FrameMoment moment_; ///< without a margin
    ScenePose pose_;
    float exposure_ = 0;
    NumberedView view_;
    int passes_ = 0; ///< of the whole picture at one sample a pixel, of what does not move
    int sent_passes_ = 0;
    int repeated_ = 0; ///< of the same picture
    bool due_ = false;
    double sent_at_ = 0;
};

} // namespace framelet::bench
