// When a whole frame will be shown, and what there will be to see: what those render for who show no picture that they
// have not sent. In: what frames took lately, scene and camera as the server knows them. Out: a camera, a scene time.
#pragma once

#include <deque>

#include "tests/evaluation/method.h"

namespace framelet::bench {

struct FrameMoment {
    Camera camera;
    SceneTime time = 0;
};

/// A frame is on display from when it has come until the next one has: it is rendered for the middle of that. The
/// scene's animation and its own camera are known ahead, as long as its clock runs. What the viewer does with the
/// camera goes on at constant velocity for a while at most.
class FrameForecast {
public:
    /// `viewer_seconds`: from a frame's arrival until it shows.
    FrameForecast(MethodSetup const& setup, double viewer_seconds);

    /// Once a step.
    FrameMoment moment(StepInput const& input);
    /// The step renders a frame that will be sent. `typical`: like those that follow; not one of those that take a
    /// different time since nothing moves.
    void begin(double now, bool typical);
    /// A message follows that shows the same moment better.
    void follow(double now) { unanswered_.push_back({now, false}); }
    void sent(double now);
    void answered(double arrived);

    /// From the beginning of a frame's step to the middle of its time on display, seconds.
    double lead() const { return lead_ + 0.5 * period_; }

private:
    struct Frame {
        double begun = 0;
        bool typical = false;
    };
    /// The camera in the space of the scene's own.
    struct Offset {
        Vec3 position{0};
        Quat orientation{1, 0, 0, 0};
    };

    SceneTime time_at(double when) const;
    Camera camera(StepInput const& input, SceneTime time);

    double const delay_; ///< of the camera, seconds
    double const viewer_seconds_;
    double lead_ = 0; ///< until it shows
    double period_ = 0;
    Frame last_;
    std::deque<Frame> unanswered_;
    struct Tick {
        double now = 0;
        SceneTime time = 0;
    };
    std::deque<Tick> clock_; ///< of the scene, as far back as the camera's delay
    Offset offset_, velocity_; ///< a second
    double offset_now_ = 0;
    bool has_offset_ = false;
    bool moves_ = false; ///< the viewer's part of the camera
};

} // namespace framelet::bench
