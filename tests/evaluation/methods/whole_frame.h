// Renders whole frames in turn, at their best, for every `framed` method. Each is for the moment at which it will be
// shown, at the spacing of the setup; while nothing moves, more samples are taken of all pixels until the picture is as
// good as it gets. In: scene and view. Out: the samples of one frame, and what they cost.
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
    /// `viewer_seconds`: time from a frame's arrival until it shows.
    WholeFrame(MethodSetup const& setup, double viewer_seconds);

    /// Renders a frame of the view, or adds to the last one. The step's seconds are those of rendering, and under
    /// `encode` those of the tone curve and the mean. A step without costs and samples: there is nothing to gain.
    ServerStep render(StepInput const& input);
    /// True if what was rendered is to be sent: it is better by enough than what was sent.
    bool is_due() const { return due_; }
    /// True if nothing moves and more samples would not make the picture better.
    bool is_converged() const { return passes_ == FrameGrid::offsets; }
    /// True if a picture that has converged is to be coded once more: its codec still has something to say of it and
    /// nothing else is on its way. `last_bytes`: what it took the last time.
    bool repeats(StepInput const& input, std::size_t last_bytes);
    /// Notes that what was rendered is sent once more.
    void repeat(double now) {
        ++repeated_;
        forecast_.follow(now);
    }

    /// The frame rendered last, and the view and scene time that it is for.
    FrameGrid& grid() { return *shown_; }
    NumberedView const& view() const { return view_; }
    SceneTime time() const { return moment_.time; }

    /// `viewport`: that with the margin, which is rendered. `spacings`: those that frames may have, pixels.
    Viewport viewport() const { return moving_.plane().viewport(); }
    std::vector<int> spacings() const;

    void sent(double now);
    void answered(double arrived) { forecast_.answered(arrived); }

    /// Bytes that the encoder may make of the frame rendered last, for a link that it shall neither fill nor leave
    /// idle: from what the answers say and from how long a frame takes. `encode_seconds`: cost of encoding, on the
    /// calibrated machine.
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
    std::optional<FrameGrid> still_; ///< grid for what does not move, where its spacing differs
    FrameGrid* shown_ = &moving_;
    FrameMoment moment_; ///< camera without the margin, and scene time, of the frame rendered last
    ScenePose pose_;
    float exposure_ = 0;
    NumberedView view_;
    int passes_ = 0; ///< passes over the whole of a still picture at one sample a pixel
    int sent_passes_ = 0;
    int repeated_ = 0; ///< times that the same picture was sent again
    bool due_ = false;
    double sent_at_ = 0;
};

} // namespace framelet::bench
