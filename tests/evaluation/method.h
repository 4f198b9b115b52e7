// A method: one way of bringing a scene's picture to a viewer, which the evaluation compares with others. The server's
// half renders and encodes a step at a time, the viewer's half takes the bytes and keeps a picture. Neither knows
// clock, link or reference.
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

/// CPU seconds by stage, on the calibrated machine.
struct StageSeconds {
    double render = 0, response = 0, encode = 0; ///< server
    double decode = 0, reconstruct = 0; ///< viewer

    double server() const { return render + response + encode; }
    double viewer() const { return decode + reconstruct; }
};

/// Parts of `framelet` that can be left out; true: the part is there.
struct FrameletParts {
    bool spacing = true; ///< spacing adapts to the picture; else one sample a pixel, finer only when nothing is due
    bool probes = true;
    bool link_budget = true; ///< rate and batches are bounded by what the link carries
    bool loss = true; ///< framelets are coded with loss where the link asks for it
    bool skip = true; ///< what the viewer has already is not sent
    bool reprojection = true; ///< the viewer moves what it holds
    bool byte_prices = true; ///< samples cost by the bytes that they take, where the link is scarce
    bool predictions = true; ///< colour is predicted from what the viewer holds
    // The server's parts for a viewer that moves what it holds:
    bool few_moments = true; ///< moments last for several cycles; else every cycle begins another one
    /// A moment is rendered for the time at which it ends, and not for that at which it begins.
    bool look_ahead = true;
    /// A moment in which the scene will jump is rendered as after the jump, and shown from then on.
    bool awaited_switches = true;
    bool camera_lead = true; ///< a moment's camera is ahead of the moment's time
    /// Unshaded rays check the visibility that the mirror cannot know.
    bool visibility = true;
    bool planned_together = true; ///< the samples of several cycles are planned together
    bool coarse_first = true; ///< after a change of light all is rendered coarsely first
    bool four_rays = true; ///< while anything moves a sample may be the mean of four rays
    bool restlessness = true; ///< change is expected of what turns, of outlines and of reflections
    // The parts of a viewer that moves what it holds:
    /// Bodies that rest are held as what stands is, and the server knows of it too.
    bool rest = true;
    bool held_moments = true; ///< framelets of 16 moments are held, and not of 4
    bool outline_filter = true;
    /// Where nearly nothing held would show (a cut), the held picture stays as it was rendered.
    bool kept_cuts = true;
};

/// Parts by which the rivals are at their best. Each can be left out.
struct RivalParts {
    bool accumulate = true; ///< while nothing moves, further samples make the picture better and better
    bool ahead = true; ///< frames are rendered for the time at which they will be shown
    /// Pixels from sample to sample while something moves: 1, 2 or 4; 0: the one of least
    /// error is chosen.
    int spacing = 0;
    /// Margin around the viewport, as a share of its sides, where the viewer moves frames; < 0: the one of least error
    /// is chosen.
    double margin = -1;
};
/// Rivals without these parts: whole frames in turn, each rendered anew, one sample a pixel.
inline constexpr RivalParts plain_rivals{false, false, 1, 0};

/// Settings that a method is told once, when it is made.
struct MethodSetup {
    Viewport viewport;
    CostTable costs;
    double machine = 1; ///< how many times slower the server is than the calibrated machine
    double frames_per_second = 10; ///< whole frames a second, at one sample a pixel, that this server reaches
    double bits_per_second = 0; ///< rate of the link at the start, for methods that control their rate; 0: unlimited
    std::uint64_t seed = 1;
    double delay_seconds = 0; ///< delay of the link, one way, for methods that measure it
    double bias = 0; ///< -1 (spatial fidelity) .. 1 (temporal), for methods that have a bias
    std::size_t batch_framelets = 0; ///< most framelets of one batch; 0: what a cycle has time for
    FrameletParts parts{};
    RivalParts rivals{}; ///< a spacing left open is 1, a margin left open is none
    double clock_offset = 1000; ///< server's clock at time 0 of the run, seconds; the run begins before that
    SessionTimes* times = nullptr; ///< gets the times that the stages of framelet's own methods take; null: nobody asks
};

/// A message as the viewer's answer tells of it.
struct DeliveredMessage {
    double bytes = 0;
    double seconds = 0; ///< time from its first byte to its last, by the viewer's clock
};

/// Input of a step of the server's half. The scene is posed for this moment.
struct StepInput {
    BenchScene& scene; ///< methods that render ahead may pose it anew
    SceneTime time = 0;
    double now = 0; ///< seconds on the run's clock; goes on while the scene stands still
    NumberedView view; ///< the newest camera that the server knows
    double waiting_bytes = 0; ///< bytes sent and not on the way yet, as the sender's socket knows
    /// Messages that were answered since the last step.
    std::span<DeliveredMessage const> delivered;
    bool clock_set = false; ///< since the last step the scene's clock was set
};

/// Result of a step: one message to the viewer. Empty message: nothing to send; where no time was spent either, there
/// was nothing to do.
struct ServerStep {
    std::vector<std::byte> message;
    StageSeconds seconds; ///< time until the message is sent
    StageSeconds later; ///< time spent after that, for what the next step sends
    std::uint64_t samples = 0; ///< samples rendered
    std::uint64_t sent_samples = 0; ///< samples in the message; counted by framelet's own methods only
    /// Run's time at which the content of the message was begun; empty: in this step.
    std::optional<double> begun;
};

struct ViewerStep {
    StageSeconds seconds;
};

/// The bound on the messages that may be on their way.
struct Window {
    std::size_t messages = 2;
    /// True: counted beyond what a round trip holds, as for a sender that has measured it; false: counted in all.
    bool beyond_round_trip = true;
};

class Method {
public:
    virtual ~Method() = default;

    virtual ServerStep produce(StepInput const& input) = 0;
    /// Takes a message. Each comes once, in order.
    virtual ViewerStep consume(std::vector<std::byte> const& message) = 0;
    virtual Picture const& picture() const = 0;
    /// Draws the viewer's picture anew for a camera and a scene time, in methods that do so without a message.
    virtual ViewerStep present(NumberedView const&, SceneTime) { return {}; }
    /// Scene time of the picture's content, mean over its pixels.
    virtual double mean_sample_time() const = 0;
    /// The method's scheduler, for looking at its decisions; null for methods that have none.
    virtual AdaptiveRefresh const* scheduler() const { return nullptr; }
    /// Called when a message of so many bytes has been handed to the link.
    virtual void sent(double /*now*/, double /*bytes*/) {}
    /// Called when the viewer's answer to the oldest unanswered message has come; `arrived`: when that message had
    /// arrived.
    virtual void answered(double /*now*/, double /*arrived*/) {}
    /// False while the method waits for the link to carry what was sent.
    virtual bool has_room(double /*now*/) const { return true; }
    /// The bound on how far the server may be ahead of the viewer; one more message is rendered meanwhile.
    virtual Window window() const { return {}; }
};

/// Names of all methods, in the order in which they are charted.
std::vector<std::string> const& method_names();

/// True if the method heeds `batch_framelets`. Throws InputError where there is no method of that name.
bool has_batches(std::string_view name);

/// True if `RivalParts::spacing` or `RivalParts::margin` makes a difference to the method. Both throw InputError
/// likewise.
bool has_spacing(std::string_view name);
bool has_margin(std::string_view name);

/// Makes the method of that name. Throws InputError where there is none.
std::unique_ptr<Method> make_method(std::string_view name, MethodSetup const& setup);

} // namespace framelet::bench
