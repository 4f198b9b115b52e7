// Forecasts when a whole frame will be shown, and what there will be to see, for methods whose viewers show only
// pictures that were sent. In: what frames took lately, scene and camera as the server knows them. Out: a camera, a
// scene time.
#pragma once

#include <deque>

#include "tests/evaluation/method.h"

namespace framelet::bench {

struct FrameMoment {
    Camera camera;
    SceneTime time = 0;
};

/// A frame is on display from its arrival until that of the next one: it is rendered for the middle of that time. The
/// scene's animation and its own camera are known ahead, as long as its clock runs. The viewer's motion of the camera
/// is extrapolated at constant velocity, for a while at most.
class FrameForecast {
public:
    /// `viewer_seconds`: time from a frame's arrival until it shows.
    FrameForecast(MethodSetup const& setup, double viewer_seconds);

    /// Camera and scene time for which this step's frame is to be rendered. To be called once a step.
    FrameMoment moment(StepInput const& input);
    /// Called when a step renders a frame that will be sent. `typical`: like those that follow; not one of those that
    /// take a different time since nothing moves.
    void begin(double now, bool typical);
    /// Called when a message follows that shows the same moment better.
    void follow(double now) { unanswered_.push_back({now, false}); }
    void sent(double now);
    void answered(double arrived);

    /// Time from the beginning of a frame's step to the middle of its time on display, seconds.
    double lead() const { return lead_ + 0.5 * period_; }

private:
    struct Frame {
        double begun = 0;
        bool typical = false;
    };
    /// Offset of the camera in the space of the scene's own.
    struct Offset {
        Vec3 position{0};
        Quat orientation{1, 0, 0, 0};
    };

    SceneTime time_at(double when) const;
    Camera camera(StepInput const& input, SceneTime time);

    double const delay_; ///< delay with which the server knows the camera, seconds
    double const viewer_seconds_;
    double lead_ = 0; ///< mean time from the beginning of a frame's step until it shows, seconds
    double period_ = 0;
    Frame last_;
    std::deque<Frame> unanswered_;
    struct Tick {
        double now = 0;
        SceneTime time = 0;
    };
    std::deque<Tick> clock_; ///< the scene's clock, as far back as the camera's delay
    Offset offset_, velocity_; ///< the viewer's part of the camera, and its change a second
    double offset_now_ = 0;
    bool has_offset_ = false;
    bool moves_ = false; ///< the viewer's part of the camera changes
};

} // namespace framelet::bench
