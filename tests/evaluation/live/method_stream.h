// A method of the evaluation behind the stream interface of the real server: what the virtual clock drives, driven by
// the server's loop. In and out as `ViewerStream` says; a batch's payload is the method's message.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "server/sampling/plan/view_state.h"
#include "server/stream/viewer_stream.h"
#include "tests/evaluation/method.h"

namespace framelet::bench {

class MethodStream final : public ViewerStream {
public:
    /// The scene must outlive it. `setup`: its viewport is replaced by the viewer's.
    MethodStream(std::string name, BenchScene& scene, MethodSetup setup);

    void take(StreamEvent const& event) override;
    Step plan(Turn const& turn, PosedScene& scene) override;
    /// The method poses the scene for itself.
    SceneTime moment() const override { return 0; }
    void render(PosedScene const& scene) override;
    bool learn(PosedScene const& scene) override;
    EncodedBatch encode() override;

    bool is_complete() const override { return idle_; }
    std::uint64_t last_batch() const override { return number_; }
    TurnFigures const& planned_figures() const override { return figures_; }
    TurnFigures const& learnt_figures() const override { return figures_; }

private:
    std::string const name_;
    BenchScene& scene_;
    MethodSetup setup_;
    std::unique_ptr<Method> method_;
    NumberedView view_;
    int scene_camera_ = -1;
    Turn turn_;
    std::deque<std::pair<std::uint64_t, double>> in_flight_; ///< numbers and bytes
    std::vector<DeliveredMessage> delivered_;
    std::uint64_t number_ = 0;
    /// What was made for a moment.
    struct Made {
        ServerStep step;
        NumberedView view;
        SceneTime time = 0;
    };
    std::mutex mutex_; // the next one may be rendered while one is learnt
    std::deque<Made> rendered_; ///< and not learnt, in order
    Made learnt_; ///< for `encode`, which may go on beside either
    TurnFigures figures_;
    bool idle_ = false; ///< it had nothing to do
    std::optional<ViewState> idle_of_; ///< for that
};

} // namespace framelet::bench
