// A viewer and its stream of the server on a clock of their own, as server and viewer run them but without sockets and
// threads: batches and answers take a while, a batch is planned before the one before it is learnt. In: what the viewer
// does. Out: its picture.
#pragma once

#include <deque>
#include <utility>

#include "client/core/picture/session_pictures.h"
#include "common/clock_state.h"
#include "protocol/codec/batch_codec.h"
#include "server/stream/framelet_stream.h"
#include "tests/evaluation/bench_scene.h"

namespace framelet::bench {

class PausedViewer {
public:
    /// `rate`: samples a pixel and second that the server renders. The scene's clock stands at `start`.
    PausedViewer(BenchScene& scene, Viewport viewport, double rate, SceneTime start);

    /// Looks through a camera of the scene, or (`scene_camera` -1) through `camera`.
    void look(Camera const& camera, int scene_camera);
    void resize(Viewport viewport);
    /// Sets the scene's clock.
    void set_clock(ClockState const& clock);
    void set_time(SceneTime time) { set_clock({time, false, 1}); }

    /// Runs for so many seconds.
    void run(double seconds);
    /// Runs until the viewer's picture is complete; false where it is not within so many seconds.
    bool run_until_complete(double most_seconds);

    double now() const { return now_; }
    SceneTime scene_time() const { return time_at(now_); }
    Camera const& camera() const { return view_.camera; }
    Picture const& picture() const { return picture_; }
    /// Samples rendered so far.
    double samples() const { return samples_; }

private:
    static constexpr double delay = 0.015; ///< from server to viewer and from viewer to server, seconds
    static constexpr double frame = 1.0 / 60; ///< from picture to picture of the viewer, seconds
    static constexpr double least_turn = 0.002; ///< of the server, seconds

    struct SentBatch {
        double arrives = 0;
        EncodedBatch batch;
    };

    SceneTime time_at(double now) const;
    void tell(decltype(StreamEvent::what) what);
    void advance(double until);
    void take_turn();
    void finish();
    void receive();
    void show();
    bool is_settled() const;

    BenchScene& scene_;
    double const rate_;
    double now_ = 1; ///< seconds
    double server_free_ = 1, next_picture_ = 1;

    // The server's side.
    FrameletStream stream_;
    ClockState clock_; ///< as it was set last
    double clock_set_ = 1; ///< when, seconds
    std::deque<StreamEvent> events_; ///< on their way to the server, each with the time at which it comes
    bool is_unlearnt_ = false;
    double samples_ = 0;
    std::uint64_t seen_number_ = 0; ///< of the newest camera that the server knows

    // The viewer's side.
    NumberedView view_;
    int scene_camera_ = -1;
    ClockState known_clock_; ///< as the viewer knows it
    double known_clock_set_ = 1;
    double clock_known_from_ = 1; ///< when the viewer comes to know `clock_`, seconds
    std::deque<SentBatch> batches_; ///< on their way to the viewer
    BatchCodec codec_;
    BatchMemory received_;
    SessionPictures pictures_;
    Picture picture_;
    std::vector<PixelRect> changed_;
};

} // namespace framelet::bench
