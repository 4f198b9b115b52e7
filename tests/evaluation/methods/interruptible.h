// Both halves of the method `interruptible`.
#pragma once

#include <array>

#include "tests/evaluation/codecs/delivery_rate.h"
#include "tests/evaluation/methods/frame_forecast.h"
#include "tests/evaluation/methods/frame_grid.h"
#include "tests/evaluation/methods/h264_frames.h"
#include "tests/evaluation/methods/margin.h"
#include "tests/evaluation/methods/refinement_gain.h"

namespace framelet::bench {

class Interruptible final : public Method {
public:
    explicit Interruptible(MethodSetup const& setup);

    ServerStep produce(StepInput const& input) override;
    ViewerStep consume(std::vector<std::byte> const& message) override { return viewer_.consume(message); }
    Picture const& picture() const override { return viewer_.picture(); }
    double mean_sample_time() const override { return viewer_.time(); }
    void sent(double now, double) override { forecast_.sent(now); }
    void answered(double, double arrived) override { forecast_.answered(arrived); }
    /// Four messages, since levels are small, the first ones above all.
    Window window() const override { return {4}; }

    /// Level rendered last: 0 is the coarsest; -1: none yet.
    int level() const { return level_; }
    /// True if that level was the first one of its frame.
    bool begins() const { return begins_; }

private:
    static constexpr int last_level = RefinementGain::levels - 1;

    bool is_still(StepInput const& input, FrameMoment const& moment) const;
    bool is_outdated(double now) const;
    int first_level(double now) const;
    ServerStep render(StepInput const& input, bool still);

    MethodSetup const setup_;
    DeliveryRate rate_;
    FrameForecast forecast_;
    std::array<FrameGrid, RefinementGain::levels> grids_;
    RefinementGain gain_;
    std::array<double, RefinementGain::levels> seconds_{}; ///< seconds that each level took
    int level_ = -1;
    FrameMoment moment_;
    ScenePose pose_;
    double meant_ = 0; ///< time at which the frame is to be seen, by the run's clock
    int frame_ = 0;
    bool begins_ = false; ///< the level that comes begins a new frame
    ScaledH264Encoder encoder_;
    H264FrameViewer viewer_;
};

} // namespace framelet::bench
