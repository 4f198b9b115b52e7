// One way of bringing a scene's picture to a viewer: what the evaluation compares. The server's half renders and
// encodes a step at a time, the viewer's half takes the bytes and keeps a picture. Neither knows clock, link or
// reference.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/image.h"
#include "tests/evaluation/bench_scene.h"
#include "tests/evaluation/cost_table.h"

namespace framelet::bench {

/// CPU seconds by stage, of the calibrated machine.
struct StageSeconds {
    double render = 0, response = 0, encode = 0; ///< server
    double decode = 0, reconstruct = 0; ///< viewer

    double server() const { return render + response + encode; }
    double viewer() const { return decode + reconstruct; }
};

/// What a method is told once.
struct MethodSetup {
    Viewport viewport;
    CostTable costs;
    double machine = 1; ///< how many times slower than the calibrated machine the server is
    double frames_per_second = 10; ///< what whole frames at one sample a pixel reach on that server
    double bits_per_second = 0; ///< of the link, for those who control their rate; 0: unlimited
    std::uint64_t seed = 1;
    std::size_t batch_framelets = 0; ///< most framelets of one batch; 0: what a cycle has time for
};

/// What the server's half works on. The scene is posed for this moment.
struct StepInput {
    BenchScene const& scene;
    SceneTime time = 0;
    NumberedView view; ///< the newest camera that the server knows
    double backlog_seconds = 0; ///< what the link has yet to carry, as its sender sees it
};

/// One message to the viewer. Empty: nothing to send for this view.
struct ServerStep {
    std::vector<std::byte> message;
    StageSeconds seconds;
    std::uint64_t samples = 0;
};

struct ViewerStep {
    StageSeconds seconds;
};

class Method {
public:
    virtual ~Method() = default;

    virtual ServerStep produce(StepInput const& input) = 0;
    /// Messages come once each and in order.
    virtual ViewerStep consume(std::vector<std::byte> const& message) = 0;
    virtual Picture const& picture() const = 0;
    /// Scene time of what the picture shows, mean over its pixels.
    virtual double mean_sample_time() const = 0;
    /// Messages that may be on their way before the viewer has answered; one more is rendered meanwhile.
    virtual std::size_t most_in_flight() const { return 2; }
};

/// Names in the order in which they are charted.
std::vector<std::string> const& method_names();

/// Throws InputError where there is no method of that name.
std::unique_ptr<Method> make_method(std::string_view name, MethodSetup const& setup);

} // namespace framelet::bench
