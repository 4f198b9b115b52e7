// Runs one method on the virtual clock: server, link and viewer in turn, each stage taking the time that the cost table
// says. In: scene, method, parameters. Out: what was shown at each reference time, and what it cost.
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
#include "tests/evaluation/scene_events.h"

namespace framelet::bench {

/// Who pays for the viewer's work: a machine of its own (`server`), or the server's pool (`total`, as in
/// [Stephens 2011]).
enum class Counting { server, total };

struct RunParameters {
    Viewport viewport{256, 256};
    double start = 0; ///< scene time at which the measured time begins, seconds
    double seconds = 1; ///< length of the measured time, seconds
    double reference_rate = 120; ///< measurements a second
    /// Reference times in seconds of the run, ascending, instead of `reference_rate`; empty: that rate.
    std::vector<double> reference_times{};
    double frames_per_second = 10; ///< speed of the machine: samples a displayed pixel and second, rendered and encoded
    LinkParameters link;
    Counting counting = Counting::server;
    std::uint64_t seed = 1;
    double bias = 0; ///< -1 (spatial fidelity) .. 1 (temporal)
    std::size_t batch_framelets = 0; ///< as in MethodSetup
    double scene_stops = INFINITY; ///< seconds of the run from which on scene and camera stand still
    RivalParts rivals{}; ///< as in MethodSetup
    SessionTimes* times = nullptr; ///< likewise
    double clock_offset = MethodSetup{}.clock_offset; ///< likewise
    /// > 0: the viewer connects this many seconds before the measured time, and the scene runs already.
    double fresh_lead = 0;
    /// The viewer sets the scene's clock; like its camera, the server knows of that one delay late. In order of time.
    std::vector<ClockSetting> clock_settings{};
};

/// Setup that such a run gives its method, on a machine that is `machine` times slower than the calibrated one.
MethodSetup method_setup(RunParameters const& parameters, double machine, CostTable const& costs);

/// Seconds by which a run begins before the measured time: the scene stands while every method finishes a picture, and
/// then, as far as it has begun by then, runs, so that no method shows that picture for long.
double lead_seconds(RunParameters const& parameters);
std::size_t reference_count(RunParameters const& parameters);
double reference_time(RunParameters const& parameters, std::size_t index);

/// Scene time at a time of the run, to one who hears of each setting of the clock `late` seconds after it; the measured
/// time begins at 0 of the run.
SceneTime scene_time(RunParameters const& parameters, double now, double late = 0);

/// Factor by which a machine is slower than the calibrated one if it renders and encodes whole frames of this scene, at
/// one sample a pixel, at the rate of the parameters.
double machine_factor(BenchScene& scene, RunParameters const& parameters, CostTable const& costs);

/// Receives the picture shown at a reference time. `age`: reference time less the mean scene time of the picture's
/// pixels, seconds.
using OnReferenceTime = std::function<void(std::size_t index, Picture const& shown, double age)>;

/// Receives a step of the server that began at `start`, which may be before the measured time.
using OnStep = std::function<void(double start, ServerStep const& step)>;

struct RunResult {
    StageSeconds cpu; ///< CPU seconds spent in the measured time; server stages in those of the run's machine
    std::uint64_t samples = 0, sent_samples = 0; ///< as in ServerStep
    std::uint64_t bytes = 0;
    std::uint64_t messages = 0;
    std::vector<double> displayed; ///< times of the run at which the picture changed
    /// A sent message: when, how many bytes, and how many seconds it waited for what was before it.
    struct Delivery {
        double sent = 0, bytes = 0, queueing = 0;
    };
    std::vector<Delivery> deliveries;
    double mean_delay = 0; ///< mean time from the start of a step until its picture shows, seconds
};

/// Runs the method. Calls `on_reference_time` once for each reference time, in order, and `on_step`, where there is
/// one, after each step.
RunResult run_method(BenchScene& scene, Method& method, RunParameters const& parameters, double machine,
                     OnReferenceTime const& on_reference_time, OnStep const& on_step = {});

} // namespace framelet::bench
