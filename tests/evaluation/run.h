// One run of one method on the virtual clock: server, link and viewer in turn, each stage taking the time that the cost
// table says. In: scene, method, parameters. Out: what was shown at each reference time, and what it cost.
//
// The server is one pool of processors. Every stage is taken to spread over all of it, so that stages one after the
// other take as long as the same stages overlapped, and a picture is never later than with the best pipeline. The
// viewer is one processor of the calibrated machine, of its own.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "tests/evaluation/codecs/simulated_link.h"
#include "tests/evaluation/method.h"

namespace framelet::bench {

/// Who pays for the viewer's work: a machine of its own, or the server's pool (as in 004, total CPU).
enum class Counting { server, total };

struct RunParameters {
    Viewport viewport{256, 256};
    double start = 0; ///< scene time at which the measured time begins, seconds
    double seconds = 1; ///< of scene time that are measured
    double reference_rate = 120; ///< measurements a second
    std::vector<double> reference_times{}; ///< where there are any: seconds of the run, ascending, instead of that rate
    double frames_per_second = 10; ///< the machine: samples a displayed pixel and second that it renders and encodes
    LinkParameters link;
    Counting counting = Counting::server;
    std::uint64_t seed = 1;
    double bias = 0; ///< -1 (spatial fidelity) .. 1 (temporal)
    std::size_t batch_framelets = 0; ///< as in MethodSetup
    double scene_stops = INFINITY; ///< seconds of the run, from which on scene and camera stand still
    RivalParts rivals{}; ///< as in MethodSetup
    SessionTimes* times = nullptr; ///< likewise
    double clock_offset = MethodSetup{}.clock_offset; ///< likewise
    double fresh_lead = 0; ///< > 0: the viewer comes so long before the measured time, and the scene runs already
};

/// What such a run tells its method, on a machine of this speed.
MethodSetup method_setup(RunParameters const& parameters, double machine, CostTable const& costs);

/// So long before the measured time a run begins: while the scene stands, so that every method has a finished picture,
/// and then, as far as the scene has begun by then, runs, so that none shows it for long.
double lead_seconds(RunParameters const& parameters);
std::size_t reference_count(RunParameters const& parameters);
double reference_time(RunParameters const& parameters, std::size_t index);

/// What the scene's clock says at a time of the run's, in which the measured time begins at 0.
SceneTime scene_time(RunParameters const& parameters, double now);

/// How many times slower than the calibrated machine one is that renders and encodes whole frames of this scene, at one
/// sample a pixel, at the rate of the parameters.
double machine_factor(BenchScene& scene, RunParameters const& parameters, CostTable const& costs);

/// What was shown at a reference time. `age`: reference time less the mean scene time of the picture's pixels, seconds.
using OnReferenceTime = std::function<void(std::size_t index, Picture const& shown, double age)>;

/// What the server did in a step that began at `start`, which may be in the lead-in.
using OnStep = std::function<void(double start, ServerStep const& step)>;

struct RunResult {
    StageSeconds cpu; ///< spent in the measured time; server stages in seconds of the run's machine
    std::uint64_t samples = 0, sent_samples = 0; ///< as in ServerStep
    std::uint64_t bytes = 0;
    std::uint64_t messages = 0;
    std::vector<double> displayed; ///< times at which the picture changed
    /// What was sent when, and how long it waited for what was before it.
    struct Delivery {
        double sent = 0, bytes = 0, queueing = 0;
    };
    std::vector<Delivery> deliveries;
    double mean_delay = 0; ///< from the start of a step until its picture shows, seconds
};

/// `on_reference_time` is called once for each, in order; `on_step`, where there is one, after each step.
RunResult run_method(BenchScene& scene, Method& method, RunParameters const& parameters, double machine,
                     OnReferenceTime const& on_reference_time, OnStep const& on_step = {});

} // namespace framelet::bench
