// Puts a method of the evaluation behind the stream interface of the real server: the server's loop drives what
// otherwise the virtual clock drives. In and out as `ViewerStream` says; a batch's payload is the method's message.
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
    /// The scene must outlive it. The viewer's viewport replaces that of `setup`.
    MethodStream(std::string name, BenchScene& scene, MethodSetup setup);

    void take(StreamEvent const& event) override;
    Step plan(Turn const& turn, PosedScene& scene) override;
    /// 0: the method poses the scene for itself.
    SceneTime moment() const override { return 0; }
    void render(PosedScene const& scene) override;
    bool learn(PosedScene& scene) override;
    EncodedBatch encode() override;

    bool is_complete() const override { return idle_; }
    std::uint64_t last_batch() const override { return number_; }
    TurnFigures const& planned_figures() const override { return figures_; }
    TurnFigures const& learnt_figures() const override { return figures_; }

private:
    void gather_light(std::size_t samples, double samples_took);

    std::string const name_;
    BenchScene& scene_;
    MethodSetup setup_;
    std::unique_ptr<Method> method_;
    NumberedView view_;
    int scene_camera_ = -1;
    Turn turn_;
    std::deque<std::pair<std::uint64_t, double>> in_flight_; ///< numbers and bytes of the batches in flight
    std::vector<DeliveredMessage> delivered_;
    std::uint64_t number_ = 0;
    /// A step's result and what it was made for.
    struct Made {
        ServerStep step;
        NumberedView view;
        SceneTime time = 0;
    };
    std::mutex mutex_; // guards `rendered_`: a step may be rendered while the one before is learnt
    std::deque<Made> rendered_; ///< steps rendered and not learnt yet, in order
    Made learnt_; ///< the step for `encode`, which may run beside the next turn's `render`
    TurnFigures figures_;
    bool idle_ = false; ///< the method had nothing to do for `idle_of_`
    std::optional<ViewState> idle_of_; ///< state for which the method had nothing to do; empty: an event came since
};

} // namespace framelet::bench
