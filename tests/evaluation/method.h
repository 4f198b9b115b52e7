// One way of bringing a scene's picture to a viewer: what the evaluation compares. The server's half renders and
// encodes a step at a time, the viewer's half takes the bytes and keeps a picture. Neither knows clock, link or
// reference.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/image.h"
#include "tests/evaluation/bench_scene.h"
#include "tests/evaluation/cost_table.h"
#include "tests/evaluation/session_times.h"

namespace framelet {
class AdaptiveRefresh;
}

namespace framelet::bench {

/// CPU seconds by stage, of the calibrated machine.
struct StageSeconds {
    double render = 0, response = 0, encode = 0; ///< server
    double decode = 0, reconstruct = 0; ///< viewer

    double server() const { return render + response + encode; }
    double viewer() const { return decode + reconstruct; }
};

/// Parts of `framelet` that can be left out.
struct FrameletParts {
    bool spacing = true; ///< adapts to the picture; else one sample a pixel, finer only when nothing is due
    bool price = true; ///< of a sample, follows the budget; else it is always cheap, and urgency alone decides
    bool probes = true;
    bool periodic_refresh = true;
    bool link_budget = true; ///< rate and batches are bounded by what the link carries
    bool loss = true; ///< where the link asks for it
    bool skip = true; ///< of what the viewer has already
    bool reprojection = true; ///< by the viewer
    bool byte_prices = true; ///< samples cost by the bytes that they take, where the link is scarce
    bool predictions = true; ///< of colour, from what the viewer holds
    // What the server does for a viewer that moves what it holds.
    bool few_moments = true; ///< else every cycle is of another one
    bool look_ahead = true; ///< a moment is of when it ends, and not of when it begins
    bool awaited_switches = true; ///< where the scene will jump it is of what comes after, and shown from then on
    bool camera_lead = true; ///< its camera is ahead of that
    bool mirror = true; ///< what the viewer shows says what is rendered, and not the field
    bool visibility = true; ///< of what the mirror does not know, by rays that are not shaded
    bool planned_together = true; ///< samples of several cycles
    bool coarse_first = true; ///< after a change of light
    bool four_rays = true; ///< a sample, while anything moves
    bool restlessness = true; ///< what turns, outlines and reflections are expected to change
    // What the viewer does that moves what it holds.
    bool rest = true; ///< of bodies: they are held as what stands, by the server's knowledge too
    bool held_moments = true; ///< 16, and not 4
    bool outline_filter = true;
    bool kept_cuts = true; ///< where nearly nothing of what is held would show it is shown as it was
};

/// What the rivals do to be at their best. Each part can be left out.
struct RivalParts {
    bool accumulate = true; ///< while nothing moves, a picture becomes better and better
    bool ahead = true; ///< frames are rendered for when they will be shown
    /// Pixels from sample to sample while something moves, of the oracle the most: 1, 2 or 4; 0: whichever errs least.
    int spacing = 0;
    double margin = -1; ///< around the viewport, of its sides, where the viewer moves frames; < 0: whichever errs least
};
/// Whole frames anew in turn, one sample a pixel.
inline constexpr RivalParts plain_rivals{false, false, 1, 0};

/// What a method is told once.
struct MethodSetup {
    Viewport viewport;
    CostTable costs;
    double machine = 1; ///< how many times slower than the calibrated machine the server is
    double frames_per_second = 10; ///< what whole frames at one sample a pixel reach on that server
    double bits_per_second = 0; ///< of the link at the start, for those who control their rate; 0: unlimited
    std::uint64_t seed = 1;
    double delay_seconds = 0; ///< of the link, one way, for those who measure it
    double bias = 0; ///< -1 (spatial fidelity) .. 1 (temporal), for those who know one
    std::size_t batch_framelets = 0; ///< most framelets of one batch; 0: what a cycle has time for
    FrameletParts parts{};
    RivalParts rivals{}; ///< what is left to choose is 1 and no margin
    double clock_offset = 1000; ///< what a server's clock says at time 0 of the run, which begins before that
    SessionTimes* times = nullptr; ///< of framelet's own methods: gets what their stages take
};

/// What the viewer's answer tells of a message.
struct DeliveredMessage {
    double bytes = 0;
    double seconds = 0; ///< from its first byte to its last, by the viewer's clock
};

/// What the server's half works on. The scene is posed for this moment.
struct StepInput {
    BenchScene& scene; ///< for those who render ahead: they may pose it anew
    SceneTime time = 0;
    double now = 0; ///< seconds on the run's clock; goes on while the scene stands still
    NumberedView view; ///< the newest camera that the server knows
    double waiting_bytes = 0; ///< sent and not on the way yet, as the sender's socket knows
    std::span<DeliveredMessage const> delivered; ///< what the viewer's answers say that have come since the last step
};

/// One message to the viewer. Empty: nothing to send; where no time was spent either, nothing to do.
struct ServerStep {
    std::vector<std::byte> message;
    StageSeconds seconds; ///< until the message is sent
    StageSeconds later; ///< from then on, for what the next step sends
    std::uint64_t samples = 0; ///< that were rendered
    std::uint64_t sent_samples = 0; ///< of framelet's own methods
    std::optional<double> begun; ///< when what the message shows was; nothing: in this step
};

struct ViewerStep {
    StageSeconds seconds;
};

/// How many messages may be on their way.
struct Window {
    std::size_t messages = 2;
    bool beyond_round_trip = true; ///< more than a round trip holds, as a sender may that has measured it; else in all
};

class Method {
public:
    virtual ~Method() = default;

    virtual ServerStep produce(StepInput const& input) = 0;
    /// Messages come once each and in order.
    virtual ViewerStep consume(std::vector<std::byte> const& message) = 0;
    virtual Picture const& picture() const = 0;
    /// The viewer's picture anew for a camera and a scene time, by those that do so without a message.
    virtual ViewerStep present(NumberedView const&, SceneTime) { return {}; }
    /// Scene time of what the picture shows, mean over its pixels.
    virtual double mean_sample_time() const = 0;
    /// For looking at what it decides; null for methods that have none.
    virtual AdaptiveRefresh const* scheduler() const { return nullptr; }
    /// A message of so many bytes has been handed to the link.
    virtual void sent(double /*now*/, double /*bytes*/) {}
    /// The viewer's answer to the oldest message without one has come: when that had arrived.
    virtual void answered(double /*now*/, double /*arrived*/) {}
    /// False while it leaves the link the time to carry what was sent.
    virtual bool has_room(double /*now*/) const { return true; }
    /// How far it may be ahead of the viewer; one more message is rendered meanwhile.
    virtual Window window() const { return {}; }
};

/// Names in the order in which they are charted.
std::vector<std::string> const& method_names();

/// Whether the method goes by `batch_framelets`. Throws InputError where there is no method of that name.
bool has_batches(std::string_view name);

/// Whether `RivalParts::spacing` and `RivalParts::margin` make a difference to it. Throw InputError likewise.
bool has_spacing(std::string_view name);
bool has_margin(std::string_view name);

/// Throws InputError where there is no method of that name.
std::unique_ptr<Method> make_method(std::string_view name, MethodSetup const& setup);

} // namespace framelet::bench
