#include "tests/evaluation/run.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "server/schedule/tiling.h"

namespace framelet::bench {
namespace {

/// How often a server that has nothing to do looks again.
constexpr double idle_seconds = 0.002;
/// Of a viewer's display, pictures a second.
constexpr double display_rate = 60;

void add(StageSeconds& sum, StageSeconds const& step, double server, double viewer) {
    sum.render += server * step.render;
    sum.response += server * step.response;
    sum.encode += server * step.encode;
    sum.decode += viewer * step.decode;
    sum.reconstruct += viewer * step.reconstruct;
}

/// Hands the picture out at every reference time that passes.
class Spectator {
public:
    Spectator(BenchScene const& scene, Method& method, RunParameters const& parameters, double viewer_machine,
              OnReferenceTime const& on_reference_time)
        : scene_(scene), method_(method), parameters_(parameters), viewer_machine_(viewer_machine),
          count_(reference_count(parameters)), on_reference_time_(on_reference_time) {}

    /// Until `end` the viewer goes on with what it has.
    void watch(double end) {
        while (next_ < count_ && reference_time(parameters_, next_) < end) {
            // What is seen at a time was begun when the picture before it was done.
            double const now = reference_time(parameters_, next_);
            double const begun = std::max(0.0, now - last_.seconds.viewer() * viewer_machine_);
            SceneTime const time = scene_time(parameters_, begun);
            last_ = method_.present({1, camera_at(scene_, time), parameters_.viewport}, time);
            presenting_ += viewer_machine_ * last_.seconds.viewer() * display_rate / parameters_.reference_rate;
            hand_out(method_.picture(), method_.mean_sample_time());
        }
    }

    /// Until `end` the viewer shows this.
    void watch(double end, Picture const& shown, double sample_time) {
        while (next_ < count_ && reference_time(parameters_, next_) < end) {
            hand_out(shown, sample_time);
        }
    }

    /// CPU seconds of pictures without a message.
    double presenting() const { return presenting_; }

private:
    void hand_out(Picture const& shown, double sample_time) {
        double const age = scene_time(parameters_, reference_time(parameters_, next_)) - sample_time;
        on_reference_time_(next_++, shown, age);
    }

    BenchScene const& scene_;
    Method& method_;
    RunParameters const& parameters_;
    double const viewer_machine_;
    std::size_t const count_;
    OnReferenceTime const& on_reference_time_;
    std::size_t next_ = 0;
    ViewerStep last_;
    double presenting_ = 0;
};

} // namespace

MethodSetup method_setup(RunParameters const& parameters, double machine, CostTable const& costs) {
    return {parameters.viewport,
            costs,
            machine,
            parameters.frames_per_second,
            parameters.link.bits_per_second,
            parameters.seed,
            parameters.link.delay_seconds,
            parameters.bias,
            parameters.batch_framelets,
            {},
            parameters.rivals};
}

double lead_seconds(RunParameters const& parameters) {
    return std::max(0.5, 3 / parameters.frames_per_second) + 4 * parameters.link.delay_seconds;
}

std::size_t reference_count(RunParameters const& parameters) {
    return static_cast<std::size_t>(std::lround(parameters.seconds * parameters.reference_rate));
}

double reference_time(RunParameters const& parameters, std::size_t index) {
    return static_cast<double>(index) / parameters.reference_rate;
}

SceneTime scene_time(RunParameters const& parameters, double now) {
    return parameters.start + std::clamp(now, 0.0, parameters.scene_stops);
}

double machine_factor(BenchScene& scene, RunParameters const& parameters, CostTable const& costs) {
    constexpr int probes = 8;
    ImagePlane const plane(parameters.viewport);
    auto const tiles = make_uniform_tiling(plane, plane.pixel_depth()).tiles;
    std::vector<Framelet> rendered(tiles.size());
    double segments = 0;
    for (int i = 0; i < probes; ++i) {
        pose_at(scene, parameters.start + parameters.seconds * i / probes);
        segments +=
            static_cast<double>(render_framelets(*scene.render_scene, scene.camera, plane, tiles, 0, rendered)) /
            probes;
    }
    double const samples = static_cast<double>(tiles.size() * framelet_samples);
    double const frame =
        1e-9 * (segments * costs.coherent_segment + samples * (costs.display_sample + costs.encode_sample));
    return 1 / (frame * parameters.frames_per_second);
}

RunResult run_method(BenchScene& scene, Method& method, RunParameters const& parameters, double machine,
                     OnReferenceTime const& on_reference_time, OnStep const& on_step) {
    SimulatedLink link(parameters.link);
    bool const shared = parameters.counting == Counting::total;
    double const viewer_machine = shared ? machine : 1;
    Spectator spectator(scene, method, parameters, viewer_machine, on_reference_time);
    RunResult result;
    double now = -lead_seconds(parameters);
    double viewer_free = now;
    Window const window = method.window();
    std::deque<double> in_flight; // when each message no longer counts
    struct Answer {
        double when = 0, arrived = 0;
        DeliveredMessage message;
    };
    std::deque<Answer> answers;
    std::vector<DeliveredMessage> delivered;
    Picture shown = method.picture();
    NumberedView view{0, {}, parameters.viewport};
    while (now < parameters.seconds) {
        while (!in_flight.empty() && in_flight.front() <= now) {
            in_flight.pop_front();
        }
        if (in_flight.size() >= window.messages) {
            now = in_flight.front();
            continue;
        }
        while (!answers.empty() && answers.front().when <= now) {
            method.answered(answers.front().when, answers.front().arrived);
            delivered.push_back(answers.front().message);
            answers.pop_front();
        }
        if (!method.has_room(now)) {
            now = answers.empty() ? now + idle_seconds : std::min(now + idle_seconds, answers.front().when);
            continue;
        }
        SceneTime const time = scene_time(parameters, now);
        pose_at(scene, time);
        // The camera is the viewer's: the server knows it as it was when it set out.
        Camera const camera = parameters.link.delay_seconds > 0
                                  ? camera_at(scene, scene_time(parameters, now - parameters.link.delay_seconds))
                                  : scene.camera;
        if (view.number == 0 || !(view.camera == camera)) {
            view = {view.number + 1, camera, parameters.viewport};
        }
        StepInput const input{scene, time, now, view, link.backlog_bytes(now), delivered};
        ServerStep const step = method.produce(input);
        delivered.clear();
        double const started = now;
        if (on_step) {
            on_step(started, step);
        }
        bool const measured = started >= 0;
        if (measured) {
            add(result.cpu, step.seconds, machine, 0);
            add(result.cpu, step.later, machine, 0);
            result.samples += step.samples;
        }
        now += machine * step.seconds.server();
        if (step.message.empty()) {
            now = std::max(now + machine * step.later.server(), started + idle_seconds);
            continue;
        }
        SimulatedLink::Delivery const delivery = link.send(now, step.message.size());
        method.sent(now, static_cast<double>(step.message.size()));

        double const begin = std::max(delivery.arrived, viewer_free);
        spectator.watch(begin);
        double const sample_time = method.mean_sample_time();
        shown = method.picture();
        ViewerStep const viewed = method.consume(step.message);
        double const displayed = begin + viewer_machine * viewed.seconds.viewer();
        spectator.watch(displayed, shown, sample_time);
        viewer_free = displayed;
        double const delay = parameters.link.delay_seconds;
        in_flight.push_back(displayed + (window.beyond_round_trip ? -delay : delay));
        answers.push_back({displayed + delay,
                           delivery.arrived,
                           {static_cast<double>(step.message.size()), delivery.departed - delivery.begun}});
        if (shared) {
            now += machine * viewed.seconds.viewer();
        }
        if (measured) {
            add(result.cpu, viewed.seconds, 0, viewer_machine);
            result.bytes += step.message.size();
            ++result.messages;
            result.mean_delay += displayed - step.begun.value_or(started);
            result.displayed.push_back(displayed);
            result.deliveries.push_back({now, static_cast<double>(step.message.size()), delivery.begun - now});
        }
        now += machine * step.later.server();
    }
    spectator.watch(INFINITY);
    result.cpu.reconstruct += spectator.presenting();
    result.mean_delay /= std::max<double>(1, static_cast<double>(result.messages));
    return result;
}

} // namespace framelet::bench
