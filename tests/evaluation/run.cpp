#include "tests/evaluation/run.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "client/core/picture/making_time.h"
#include "tests/uniform_tiling.h"

namespace framelet::bench {
namespace {

/// Seconds after which a server that has nothing to do looks again, as `SessionLoop` does.
constexpr double idle_seconds = 0.005;
/// Rate of a viewer's display, pictures a second.
constexpr double display_rate = 60;

void add_server(StageSeconds& sum, StageSeconds const& step, double machine) {
    sum.render += machine * step.render;
    sum.response += machine * step.response;
    sum.encode += machine * step.encode;
}

/// The viewer as one processor: it decodes what arrives at once, and in the time that this leaves makes a picture for
/// each display frame. As in the client, a picture is of the moment at which it is expected to be ready.
class SimulatedViewer {
public:
    SimulatedViewer(BenchScene const& scene, Method& method, RunParameters const& parameters, double machine,
                    double now, OnReferenceTime const& on_reference_time, RunResult& result)
        : scene_(scene), method_(method), parameters_(parameters), machine_(machine),
          count_(reference_count(parameters)), on_reference_time_(on_reference_time), result_(result), free_(now),
          next_frame_(now) {}

    /// Makes all pictures that are to be begun before the time `end`.
    void show_until(double end) {
        for (double begin = next_begin(); begin < end; begin = next_begin()) {
            make_picture(begin);
        }
    }

    /// Decodes a message that arrived at `arrived` and whose content was begun at `begun`; messages come in the order
    /// of their arrival. Returns when it is decoded, which the answer says. A picture that is being made meanwhile is
    /// late by that.
    double receive(double arrived, double begun, std::vector<std::byte> const& message) {
        show_until(arrived);
        StageSeconds const seconds = scaled(method_.consume(message).seconds);
        double const begin = std::max(arrived, decoder_free_);
        decoder_free_ = begin + seconds.viewer();
        free_ = std::max(free_, begin) + seconds.viewer();
        spend(begin, seconds);
        unseen_.push_back(begun);
        return decoder_free_;
    }

    /// Makes the pictures that are left to be shown, and brings the result's means up to date.
    void finish() {
        show_until(std::max(parameters_.seconds, free_));
        while (next_ < count_) {
            make_picture(next_begin());
        }
        result_.mean_delay = seen_ == 0 ? 0 : delays_ / static_cast<double>(seen_);
    }

    /// Processor seconds that the viewer's work has taken so far.
    double spent_seconds() const { return spent_seconds_; }

private:
    double next_reference() const { return reference_time(parameters_, next_); }

    /// Time at which the next picture is begun. A display frame just before a reference time waits for it, so that the
    /// compared picture is of that very moment.
    double next_begin() const {
        double const aim = std::max(next_frame_, free_ + making_.expected());
        double const reference = next_ < count_ ? next_reference() : 0;
        bool const waits = reference > aim && reference - aim < frame_seconds;
        return std::max(free_, (waits ? reference : aim) - making_.expected());
    }

    void make_picture(double begin) {
        double aim = begin + making_.expected();
        std::size_t const first = next_;
        while (next_ < count_ && next_reference() < aim + time_tolerance) {
            ++next_;
        }
        if (next_ > first) {
            aim = reference_time(parameters_, next_ - 1);
        }
        next_frame_ = std::max(next_frame_ + frame_seconds, aim + frame_seconds / 2);
        SceneTime const time = scene_time(parameters_, aim);
        StageSeconds const seconds =
            scaled(method_.present({1, camera_at(scene_, time), parameters_.viewport}, time).seconds);
        free_ = std::max(begin + seconds.viewer(), aim);
        making_.note(seconds.viewer());
        spend(begin, seconds);
        note_shown(seconds.reconstruct > 0);
        for (std::size_t i = first; i < next_; ++i) {
            double const then = scene_time(parameters_, reference_time(parameters_, i));
            on_reference_time_(i, method_.picture(), then - method_.mean_sample_time());
        }
    }

    void note_shown(bool is_moved) {
        bool const is_measured = free_ >= 0 && free_ < parameters_.seconds;
        if (is_measured && (is_moved || !unseen_.empty())) {
            result_.displayed.push_back(free_);
        }
        for (double const begun : unseen_) {
            delays_ += begun >= 0 ? free_ - begun : 0;
            seen_ += begun >= 0 ? 1 : 0;
        }
        unseen_.clear();
    }

    void spend(double when, StageSeconds const& seconds) {
        spent_seconds_ += seconds.viewer();
        if (when >= 0 && when < parameters_.seconds) {
            result_.cpu.decode += seconds.decode;
            result_.cpu.reconstruct += seconds.reconstruct;
        }
    }

    StageSeconds scaled(StageSeconds seconds) const {
        seconds.decode *= machine_;
        seconds.reconstruct *= machine_;
        return seconds;
    }

    static constexpr double frame_seconds = 1 / display_rate;
    static constexpr double time_tolerance = 1e-9;

    BenchScene const& scene_;
    Method& method_;
    RunParameters const& parameters_;
    double const machine_;
    std::size_t const count_;
    OnReferenceTime const& on_reference_time_;
    RunResult& result_;
    std::size_t next_ = 0; ///< index of the next reference time
    double free_; ///< time from which on the processor can make a picture
    double decoder_free_ = -INFINITY;
    double next_frame_; ///< time of the next display frame
    MakingTime making_;
    double spent_seconds_ = 0;
    std::vector<double> unseen_; ///< for messages that no picture shows yet: when they were begun
    double delays_ = 0;
    std::size_t seen_ = 0;
};

/// Seconds that the scene moves before the measured time.
double running_lead_seconds(RunParameters const& parameters) {
    constexpr double enough = 0.5;
    return std::clamp(parameters.start, 0.0, std::max(enough, parameters.fresh_lead));
}

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
            parameters.rivals,
            parameters.clock_offset,
            parameters.times};
}

double lead_seconds(RunParameters const& parameters) {
    return parameters.fresh_lead > 0 ? parameters.fresh_lead
                                     : std::max(0.5, 3 / parameters.frames_per_second) +
                                           4 * parameters.link.delay_seconds + running_lead_seconds(parameters);
}

std::size_t reference_count(RunParameters const& parameters) {
    return parameters.reference_times.empty()
               ? static_cast<std::size_t>(std::lround(parameters.seconds * parameters.reference_rate))
               : parameters.reference_times.size();
}

double reference_time(RunParameters const& parameters, std::size_t index) {
    return parameters.reference_times.empty() ? static_cast<double>(index) / parameters.reference_rate
                                              : parameters.reference_times[index];
}

SceneTime scene_time(RunParameters const& parameters, double now, double late) {
    return clock_at(parameters.clock_settings, parameters.start,
                    std::clamp(now, -running_lead_seconds(parameters), parameters.scene_stops), late);
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
            static_cast<double>(render_framelets(*scene.render_scene, scene.camera, plane, tiles, rendered)) / probes;
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
    RunResult result;
    double now = -lead_seconds(parameters);
    SimulatedViewer viewer(scene, method, parameters, shared ? machine : 1, now, on_reference_time, result);
    double viewer_spent = 0;
    Window const window = method.window();
    std::deque<double> in_flight; // times at which the messages cease to count as in flight
    struct Answer {
        double when = 0, arrived = 0;
        DeliveredMessage message;
    };
    std::deque<Answer> answers;
    auto const next_look = [&answers](double from) { // an answer wakes an idle server
        double const idle = from + idle_seconds;
        return answers.empty() || answers.front().when <= from ? idle : std::min(idle, answers.front().when);
    };
    std::vector<DeliveredMessage> delivered;
    NumberedView view{0, {}, parameters.viewport};
    std::size_t clock_set = 0; // how many settings of the clock the server has heard of
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
            now = next_look(now);
            continue;
        }
        double const delay = parameters.link.delay_seconds;
        SceneTime const time = scene_time(parameters, now, delay);
        pose_at(scene, time);
        // The camera is the viewer's: the server knows the one that was sent one delay ago.
        Camera const camera = delay > 0 ? camera_at(scene, scene_time(parameters, now - delay)) : scene.camera;
        if (view.number == 0 || !(view.camera == camera)) {
            view = {view.number + 1, camera, parameters.viewport};
        }
        std::size_t const set = settings_made(parameters.clock_settings, now - delay);
        bool const is_set = std::exchange(clock_set, set) != set;
        StepInput const input{scene, time, now, view, link.backlog_bytes(now), delivered, is_set};
        ServerStep const step = method.produce(input);
        delivered.clear();
        double const started = now;
        if (on_step) {
            on_step(started, step);
        }
        bool const measured = started >= 0;
        if (measured) {
            add_server(result.cpu, step.seconds, machine);
            add_server(result.cpu, step.later, machine);
            result.samples += step.samples;
            result.sent_samples += step.sent_samples;
        }
        now += machine * step.seconds.server();
        if (step.message.empty()) {
            now = std::max(now + machine * step.later.server(), next_look(started));
            continue;
        }
        SimulatedLink::Delivery const delivery = link.send(now, step.message.size());
        method.sent(now, static_cast<double>(step.message.size()));

        double const answered = viewer.receive(delivery.arrived, step.begun.value_or(started), step.message);
        in_flight.push_back(answered + (window.beyond_round_trip ? -delay : delay));
        answers.push_back({answered + delay,
                           delivery.arrived,
                           {static_cast<double>(step.message.size()), delivery.departed - delivery.begun}});
        if (shared) {
            now += viewer.spent_seconds() - std::exchange(viewer_spent, viewer.spent_seconds());
        }
        if (measured) {
            result.bytes += step.message.size();
            ++result.messages;
            result.deliveries.push_back({now, static_cast<double>(step.message.size()), delivery.begun - now});
        }
        now += machine * step.later.server();
    }
    viewer.finish();
    return result;
}

} // namespace framelet::bench
